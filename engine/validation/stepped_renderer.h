#pragma once
// The passes one by one, for checks that draw chosen voxels in a chosen order, or that look at and replace
// what one pass made before the next uses it.

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

/// What the passes before the camera leave on the device.
struct SteppedVolume {
  DeviceVolume volume;
  BlockList visible;
  AttenuationTable table;
  std::vector<std::uint32_t> voxels;  ///< the visible ones, padded indices in the order of the list
};

SteppedVolume prepareSteps(const Device& device, const Volume& volume, const Classification& classification,
                           const TableSettings& table);

/// The same table again, swept in the thinnest slabs there are: bytes [direction][voxel] as downloadTable has
/// them.
std::vector<std::vector<std::uint8_t>> sweepThinSlabs(const Device& device, const SteppedVolume& steps);

/// The sums of just these voxels (padded indices), drawn in this order. No more than are active.
std::vector<SplatSums> drawVoxels(const Device& device, const SteppedVolume& steps,
                                  std::span<const std::uint32_t> voxels, const Camera& camera,
                                  const FrameSettings& settings);

}  // namespace freevoxels
