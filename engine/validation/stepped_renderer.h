#pragma once
// Runs the passes one by one, for checks that draw chosen voxels in a chosen order, or that read or replace
// the result of one pass before the next uses it.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/attenuation/attenuation_table.h"
#include "engine/octree/block_list.h"
#include "engine/octree/device_volume.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"
#include "engine/splatting/splat_sums.h"

namespace freevoxels {

/// The device's results of the passes that do not depend on the camera.
struct SteppedVolume {
  DeviceVolume volume;
  BlockList visible;
  AttenuationTable table;
  std::vector<std::uint32_t> voxels;  ///< padded indices of the occupied voxels, in the order of the list
};

SteppedVolume prepareSteps(const Device& device, const Volume& volume, const Classification& classification,
                           const TableSettings& table);

/// The same table swept in the thinnest possible slabs: bytes [direction][voxel] as in downloadTable.
std::vector<std::vector<std::uint8_t>> sweepThinSlabs(const Device& device, const SteppedVolume& steps);

/// The sums of these voxels only (padded indices), drawn in this order; at most as many as are active.
std::vector<SplatSums> drawVoxels(const Device& device, const SteppedVolume& steps,
                                  std::span<const std::uint32_t> voxels, const Camera& camera,
                                  const FrameSettings& settings);

}  // namespace freevoxels
