#pragma once
// The scenes of a validation run: volumes of bounded size, each with a classification.

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

/// A scene with the automatic density scale and an albedo of three different components, or with a transfer
/// function of many colours over the volume's range; with emission, if it has temperatures. A volume that is
/// longer than `maximumEdge` along any axis is cut to that around the centre of its active voxels, and the
/// name says so.
ValidationScene makeValidationScene(Volume volume, SceneColor color, int maximumEdge);

}  // namespace freevoxels
