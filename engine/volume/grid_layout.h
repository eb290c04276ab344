#pragma once
// The layout of a box of values in device buffers.

#include <cstdint>
#include <glm/glm.hpp>

#include "shaders/interface.h"

namespace freevoxels {

/// x fastest. Rows are padded to a multiple of kRowAlignment with voxels without data.
struct GridLayout {
  glm::ivec3 dimensions{0};
  int rowPitch = 0;

  explicit GridLayout(glm::ivec3 size)
      : dimensions(size),
        rowPitch((size.x + shader::kRowAlignment - 1) / shader::kRowAlignment * shader::kRowAlignment) {}
  GridLayout() = default;
  std::uint64_t voxels() const {
    return std::uint64_t(dimensions.x) * std::uint64_t(dimensions.y) * std::uint64_t(dimensions.z);
  }
  /// Number of voxels including the padding.
  std::uint64_t paddedVoxels() const {
    return std::uint64_t(rowPitch) * std::uint64_t(dimensions.y) * std::uint64_t(dimensions.z);
  }
  /// Converts the padded index of a voxel (not of padding) to its index among all voxels (Volume::at).
  std::uint32_t unpaddedIndex(std::uint32_t padded) const {
    return padded - padded / std::uint32_t(rowPitch) * std::uint32_t(rowPitch - dimensions.x);
  }
};

}  // namespace freevoxels
