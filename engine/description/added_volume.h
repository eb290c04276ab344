#pragma once
// The volumes of a scene besides its first one.

#include <filesystem>
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/description/scene_description.h"

namespace freevoxels {

/// From a text "FILE[,KEY=VALUE...]" or such an object as JSON, {"volume": FILE, KEY: VALUE, ...}. Fails with ErrorKind::Usage.
AddedVolume readAddedVolume(const std::string& text);
/// The object as JSON, which readAddedVolume() takes.
std::string addedVolumeText(const AddedVolume& added);
/// The same JSON, or a name of a volume, with names of files changed by `change`, which is told whether they are of transfer functions.
nlohmann::json withFiles(nlohmann::json added, const std::function<std::string(const std::string& file, bool isFunction)>& change);

/// Reads the volumes and classifies them. A volume that somebody still holds is not read again. Fails as SceneDescription::readVolume().
std::vector<SceneVolume> openAddedVolumes(const SceneDescription& scene, const Progress& progress = {});

/// A name for a volume in memory, which InputDescription::volume of an AddedVolume may be as long as somebody holds the volume. Any thread
/// may call this.
std::string nameInMemory(const std::shared_ptr<const Volume>& volume);
/// Whether a text is such a name.
bool isInMemory(const std::string& text);
/// The volumes of a scene that have such names. Fails with ErrorKind::Usage where nobody has held one.
std::vector<std::shared_ptr<const Volume>> volumesInMemory(const SceneDescription& scene);

}  // namespace freevoxels
