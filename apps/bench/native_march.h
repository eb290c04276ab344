#pragma once
// The bar for gathered frames on a CPU: code of the host's own that marches one ray for each pixel.

#include <string_view>
#include <vector>

#include "apps/bench/measure.h"
#include "engine/vulkan/device.h"

namespace freevoxels::bench {

/// An unlit frame of a head with a transfer function or of a cloud, of N³ voxels, at 1024 x 1024 pixels: gathered by the device, and
/// marched by the host on all its cores, eight rays at a time with vector instructions, through a dense array, with one sample a slice of
/// voxels and an end where a ray is opaque. The name of the second has its ratio to the first, and how much the images differ.
std::vector<Result> nativeMarch(const Device& device, std::string_view name, int resolution, int runs);

}  // namespace freevoxels::bench
