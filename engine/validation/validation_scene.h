#pragma once
// What a validation run looks at: volumes of bounded size with a classification each.

#include <string>

#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

struct ValidationScene {
  std::string name;  ///< "procedural:cloud, 64x64x64 voxels, transfer function"
  Volume volume;
  Classification classification;
};

enum class SceneColor { Density, TransferFunction };

/// With the automatic density scale and an albedo of three different components, or with a transfer function
/// of many colours over the volume's range; with the light of its temperatures, if it has any. Longer than `maximumEdge` anywhere, the volume is cut to that
/// around the centre of its active voxels, and the name says so.
ValidationScene makeValidationScene(Volume volume, SceneColor color, int maximumEdge);

}  // namespace freevoxels
