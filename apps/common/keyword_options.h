#pragma once
// Scenes as JSON values: those of the library, and the keyword arguments of Python.

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/common/device_options.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

/// A scene and the choice of the device, of JSON objects. A key is the name of a field of a scene, with '-' or '_' ("density_scale"),
/// of the device ("device", "memory-limit"), or a section of a scene file (apps/scenes/README.md) whose value is an object of such
/// keys: {"camera": {"orbit": [35, 25]}}. Keys outside of sections override those inside. The key "scene" names a scene file that
/// supplies what the other keys leave out.
struct KeywordOptions {
  /// What the caller can use: sections of scenes, and "device" and "scene" for the keys of these. Other sections are ignored, which a
  /// whole scene has; keys of their fields alone are refused.
  using Sections = std::vector<std::string>;

  /// Reads objects, the strongest first: each gives what those before it leave open. Fails with ErrorKind::Usage for unknown keys and
  /// for fields of an object that exclude each other, with ErrorKind::Input for values of a wrong type.
  KeywordOptions(const std::vector<nlohmann::json>& layers, const Sections& sections);

  /// The sections of the options of a frame, or of a file as well; of the device only where they choose it.
  static Sections sections(bool ofFile, bool choosesDevice);

  SceneDescription scene;
  std::shared_ptr<const Holdout> holdout;  ///< in memory, in place of the file of scene.camera; null if there is none
  /// Milliseconds, more than 0, within which the frame is to be drawn, as a draft if need be.
  std::optional<double> budget;
  DeviceOptions device;
  std::vector<std::string> warnings;  ///< what the user should know of the scene file
};

/// Takes the key of a name, with '-' or '_', out of an object; nothing if it has none. Keys of sections are not looked at.
std::optional<nlohmann::json> takeKey(nlohmann::json& keywords, const std::string& name);

}  // namespace freevoxels
