#pragma once
// Scene files: a scene description as JSON, {"camera": {"fov": 35, ...}, ...}. apps/scenes/README.md lists the keys. Numbers, lists
// of numbers and words stand for the texts of the fields (scene_fields.h), which always work as well. File names are relative to the
// folder of the file.

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/description/scene_fields.h"

namespace freevoxels {

/// A file that was read, and what is checked whatever is asked of it: that its sections exist and hold objects. All functions fail
/// with ErrorKind::Input and a sentence that names the file and the key.
class SceneFile {
 public:
  explicit SceneFile(const std::filesystem::path& file);

  /// Whether the scene names a volume.
  bool hasVolume() const;
  /// Gives the description the fields that the file has, and for which `wanted` is true. Fails for unknown keys, wrong values, and
  /// fields that exclude each other.
  void applyTo(SceneDescription& description, const std::function<bool(const SceneField&)>& wanted = {}) const;

  /// Sentences for the user about keys of earlier versions, which applyTo() passes over.
  std::vector<std::string> warnings() const;

 private:
  template <typename... Args>
  [[noreturn]] void failHere(const std::string& format, Args&&... args) const;
  [[noreturn]] void failUnknown(const std::string& section, const std::string& key) const;
  const SceneField& find(const std::string& section, const std::string& key) const;

  std::filesystem::path file_;
  std::shared_ptr<const nlohmann::json> root_;
};

/// Reads a whole file.
SceneDescription readScene(const std::filesystem::path& file);

/// The description as JSON: the fields that it gives, by section. File names become relative to `folder`, or stay as they are.
nlohmann::ordered_json sceneToJson(const SceneDescription& description, const std::optional<std::filesystem::path>& folder);

/// One text of a field as JSON; names of files as in sceneToJson().
nlohmann::ordered_json fieldJson(const SceneField& field, const std::string& text, const std::optional<std::filesystem::path>& folder);

/// Writes such a file, a key on each line. Atomic. Fails with ErrorKind::Output.
void writeScene(const std::filesystem::path& file, const SceneDescription& description);

/// The texts of a field for a JSON value, none for `false` where the text may be empty. File names are relative to `folder`. Fails
/// with ErrorKind::Input and a sentence that calls the value `name`.
std::vector<std::string> fieldTexts(const SceneField& field, const nlohmann::json& value, const std::filesystem::path& folder,
                                    const std::string& name);

}  // namespace freevoxels
