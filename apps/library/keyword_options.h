#pragma once
// Options of the command line given by name, as JSON values: scenes of the library, and what keyword arguments of Python become.

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/freevoxels/device_options.h"
#include "apps/freevoxels/method_options.h"
#include "apps/freevoxels/scene_options.h"

namespace freevoxels {

/// Options of `freevoxels render`. They are read, checked and refused by the same code, so that a
/// value that the command line takes is taken here, and the sentence of an error is the same.
class KeywordOptions {
 public:
  /// `keywords` is an object; `sections` are the sections of a scene file whose options it may give. A key is an option's name with '_' in place of '-' ("density_scale"), or a section of a
  /// scene file (apps/scenes/README.md) whose value is an object of such keys: {"camera": {"orbit": [35, 25]}}. A scene
  /// file, key "scene", supplies what the other keys leave out. `volume`, a file or "procedural:NAME", takes the place of
  /// the scene file's. Fails with ExitCode::Usage for unknown keys and options
  /// that exclude each other, with ExitCode::Input for values of a wrong type.
  KeywordOptions(const nlohmann::json& keywords, std::vector<std::string> sections, const std::string& volume = "");
  KeywordOptions(const KeywordOptions&) = delete;
  KeywordOptions& operator=(const KeywordOptions&) = delete;

  /// What scene.resolveClassification reads of the options: frames of equal text share its result.
  const std::string& classificationText() const { return classificationText_; }

  SceneOptions scene;
  MethodOptions method;
  DeviceOptions device;

 private:
  void give(const std::string& section, const std::string& keyword, const nlohmann::json& value);
  CLI::Option* find(const std::string& section, const std::string& keyword);
  bool isSection(const std::string& name) const;

  const std::vector<std::string> sections_;
  CLI::App app_;
  std::vector<CLI::Option*> given_;
  std::string classificationText_;
};

}  // namespace freevoxels
