#pragma once
// Options of the command line as JSON values: the scenes of the library, and the keyword arguments of Python.

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "apps/freevoxels/device_options.h"
#include "apps/freevoxels/method_options.h"
#include "apps/freevoxels/scene_options.h"

namespace freevoxels {

/// Options of `freevoxels render`, read and checked by the command line's code, so that the same values are
/// accepted and errors have the same sentences.
class KeywordOptions {
 public:
  /// Reads the options from the object `keywords`. A key is the name of an option, with '-' or '_'
  /// ("density_scale"), or a section of a scene file (apps/scenes/README.md) whose value is an object of such
  /// keys: {"camera": {"orbit": [35, 25]}}. Only options of `sections` are accepted. The key "scene" names a
  /// scene file that supplies what the other keys leave out. `volume`, a file or "procedural:NAME", replaces
  /// that of the scene file. Fails with ErrorKind::Usage for unknown keys and options that exclude each other,
  /// with ErrorKind::Input for values of a wrong type.
  KeywordOptions(const nlohmann::json& keywords, std::vector<std::string> sections, const std::string& volume = "");
  KeywordOptions(const KeywordOptions&) = delete;
  KeywordOptions& operator=(const KeywordOptions&) = delete;

  /// Without values, for marked().
  static const KeywordOptions& all();
  /// The text of an error with the options of the command line that it names ("--draw splats") marked as parameters
  /// (engine/core/parameter.h).
  std::string marked(std::string_view text) const;

  /// The options that scene.resolveClassification reads, as text: frames of equal text share its result.
  const std::string& classificationText() const { return classificationText_; }

  SceneOptions scene;
  MethodOptions method;
  DeviceOptions device;

 private:
  void give(const std::string& section, const std::string& name, const nlohmann::json& value);
  CLI::Option* find(const std::string& section, const std::string& name);
  bool isSection(const std::string& name) const;

  const std::vector<std::string> sections_;
  CLI::App app_;
  std::vector<CLI::Option*> given_;
  std::string classificationText_;
};

}  // namespace freevoxels
