#pragma once
// What baked volumes save: the time to the first image, a preview from a file that is not in memory, and the time to bake.

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "apps/bench/measure.h"
#include "engine/vulkan/device.h"

namespace freevoxels::bench {

/// From the file to the first image in memory, of 1024 x 1024 pixels with the default lights, without the start of the program: of `input` as
/// .vdb and as .fvx. A procedural volume of `resolution`³ voxels is written first. The names have ratios to the .vdb, and of baking from memory
/// to what a render needs up to the attenuation table.
std::vector<Result> baked(const Device& device, const std::string& input, int resolution, int runs);

/// A preview of level 2 of a baked procedural:cloud, of which nothing is in the operating system's cache: from opening the file to an image of
/// 512 x 512 pixels.
Result coldPreview(const Device& device, glm::ivec3 resolution, int runs);

}  // namespace freevoxels::bench
