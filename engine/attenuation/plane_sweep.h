#pragma once
// Optical depths towards a light at all voxels of a level that need not fit into the device's memory: the sweep of ray_sweep.h, plane by
// plane from the volume's source. Only some planes are in memory at a time; the depths of voxels go to a temporary file, from which those
// of any brick can be read.

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/spool.h"
#include "engine/core/stages.h"
#include "engine/scene/source_rays.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume_source.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// A level of a volume and how it is classified.
struct SourceLevel {
  std::shared_ptr<const VolumeSource> source;
  int level = 0;
  Classification classification;
  const Volume& outline() const { return source->outline(level); }
};

class SweptLight {
 public:
  /// Codes of a brick's voxels, x fastest: sqrt(depth / kOpaqueDepth) in 16 bits, for scalars the depth of the next voxel towards the
  /// light, as light_depths.comp has it.
  using BrickCodes = std::array<std::uint16_t, ScalarBricks::kEdge * ScalarBricks::kEdge * ScalarBricks::kEdge>;

  /// COMPUTE ray_sweep.comp and light_planes.comp, a few planes of a face at a time. `source` is in the level's index space. The codes
  /// take 1 KiB on the disk for each brick with data and each of its neighbours, in the system's folder for temporary files. Of a level
  /// with a larger box than can be numbered, islands are swept (islands.h), a second time with what is between them and the light. Blocks;
  /// adds the times to `times`. Fails with ErrorKind::OutOfMemory.
  SweptLight(const Device& device, const SourceLevel& level, const RaySource& source, std::vector<StageTime>& times,
             const Progress& progress = {});

  const RaySource& source() const { return source_; }
  /// Bytes of device memory that the sweep of a light through a level takes at least.
  static std::uint64_t leastBytes(const SourceLevel& level, const RaySource& source);
  /// Reads the codes of a brick of the level; 0 where no brick nearby has data.
  void read(glm::ivec3 brick, std::span<std::uint16_t> codes) const;

 private:
  class Sweep;

  RaySource source_;
  SparseGrid<std::uint32_t> records_;  ///< by brick: 0 where there is none, or the number of its codes in `codes_`, from 1
  Spool codes_;
};

}  // namespace freevoxels
