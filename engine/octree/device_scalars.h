#pragma once
// A volume's scalars on the device, for classification after interpolation.

#include <glm/glm.hpp>
#include <optional>

#include "engine/volume/classification.h"
#include "engine/volume/volume.h"
#include "engine/vulkan/buffer.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

/// Codes of TransferTable in the bricks of Volume::scalars. Brick 0 has no data.
struct DeviceScalars {
  Buffer codes;         ///< 16 bits a voxel
  Buffer brickNumbers;  ///< uint32: number of the brick of each cell, x fastest
  Buffer table;         ///< TransferTable::texels()
  TexelView tableTexels;
  /// Words of two codes, and brick numbers. Do not exist where the device cannot view so many.
  std::optional<TexelView> codeTexels, numberTexels;
  glm::ivec3 cells{0};   ///< number of bricks along the axes
  glm::ivec3 corner{0};  ///< position of the box's voxel (0,0,0) in its brick

  double low = 0.0, high = 0.0;  ///< the scalars of the least and the greatest code

  shader::CodeBricks onDevice() const;
  /// Replaces the table by that of another function. False where scalars would have other codes; then nothing changes.
  bool reclassify(const Device& device, const Volume& volume, const TransferFunction& function, double extinctionScale);
};

/// Uploads the scalars and the table. Extinctions in the table are per world unit, times `extinctionScale`.
/// Fails with ErrorKind::OutOfMemory.
DeviceScalars uploadScalars(const Device& device, const Volume& volume, const TransferFunction& function,
                            double extinctionScale);

}  // namespace freevoxels
