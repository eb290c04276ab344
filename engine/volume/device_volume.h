#pragma once
// A classified volume on the device: scalars, extinction and the transfer function.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/core/stages.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

/// How voxels lie in device buffers: x fastest, rows padded with inactive voxels to a multiple of
/// kRowAlignment.
struct GridLayout {
  glm::ivec3 dimensions{0};
  int rowPitch = 0;

  explicit GridLayout(glm::ivec3 size);
  GridLayout() = default;
  /// Voxels with the padding.
  std::uint64_t paddedVoxels() const {
    return std::uint64_t(rowPitch) * std::uint64_t(dimensions.y) * std::uint64_t(dimensions.z);
  }
  /// Of a voxel that is no padding: its index in Volume::values.
  std::uint32_t unpaddedIndex(std::uint32_t padded) const {
    return padded - padded / std::uint32_t(rowPitch) * std::uint32_t(rowPitch - dimensions.x);
  }
  template <typename Value>
  std::vector<Value> withoutPadding(const std::vector<Value>& padded) const {
    std::vector<Value> values;
    values.reserve(padded.size() / std::size_t(rowPitch) * std::size_t(dimensions.x));
    for (auto row = padded.begin(); row != padded.end(); row += rowPitch)
      values.insert(values.end(), row, row + dimensions.x);
    return values;
  }
};

struct DeviceVolume {
  GridLayout layout;
  Buffer scalars;     ///< float
  Buffer extinction;  ///< float, per world unit; written by ClassifyPass
  QuadView extinctionQuads;
  Buffer transferPoints;  ///< vec4: opacity points, then colour points (transfer_function.glsl)
  std::uint32_t opacityPointCount = 0, colorPointCount = 0;  ///< 0 = physical
  glm::dmat4 indexToWorld{1.0};
  glm::vec3 albedo{0.0f};
  double voxelSize = 0.0;
  std::uint64_t activeVoxels = 0;  ///< no more than this many can be visible
};

DeviceVolume uploadVolume(const Device& device, const Volume& volume, const Classification& classification);

/// COMPUTE classify.comp
class ClassifyPass {
 public:
  explicit ClassifyPass(const Device& device);
  void record(Commands& commands, const DeviceVolume& volume, const Classification& classification) const;

 private:
  Pipeline pipeline_;
};

}  // namespace freevoxels
