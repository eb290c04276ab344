#pragma once
// A volume among those of a scene.

#include <memory>
#include <optional>

#include "engine/volume/classification.h"
#include "engine/volume/volume_source.h"

namespace freevoxels {

/// Its place in the world is that of the volume. The order of a scene's volumes does not matter.
struct SceneVolume {
  std::shared_ptr<const VolumeSource> source;
  Classification classification;
  std::optional<double> surface = {};  ///< in place of Lighting::surface
};

}  // namespace freevoxels
