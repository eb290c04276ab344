#pragma once
// The bricks of a scan, filled block by block with numbers of any type.

#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "engine/volume/sample_type.h"
#include "engine/volume/scalar_bricks.h"

namespace freevoxels {

/// Samples of a box of voxels, x fastest, without gaps.
struct SampleBlock {
  const std::byte* samples = nullptr;
  SampleType type = SampleType::U8;
  int components = 1;                   ///< numbers of a voxel, which follow each other
  bool isSwapped = false;               ///< whether the order of their bytes is not this machine's
  double slope = 1.0, intercept = 0.0;  ///< a voxel is sample x slope + intercept
  glm::ivec3 first{0}, extent{0};
};
using SampleSink = std::function<void(const SampleBlock&)>;

/// All bricks of a box, which take their final memory at once: beside them only the block that is put in exists.
class ScanVoxels {
 public:
  /// The box begins at a voxel of the scan.
  explicit ScanVoxels(glm::ivec3 dimensions, glm::ivec3 first = glm::ivec3(0));
  /// Takes one of the numbers of the voxels that are in the box.
  void put(const SampleBlock& block, int component = 0);
  /// The bricks, once.
  ScalarBricks take();

 private:
  glm::ivec3 dimensions_, first_, cells_;
  ScalarBricks::Bricks bricks_;
};

}  // namespace freevoxels
