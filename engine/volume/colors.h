#pragma once
// Volumes of colours, such as photographs of slices: the colour of a voxel is its albedo, and its density is how light or how opaque it is.

#include <span>
#include <vector>

#include "engine/volume/sample_type.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// The name of the albedo grid that is made of colours.
inline constexpr const char* kColorsName = "colors";

/// Fills a volume, whose box and place are known, from red, green and blue, and from opacity if there is a fourth. Numbers of 8 bits are
/// sRGB, those of 16 bits are linear; the largest number of their type is 1. The density of a voxel is its opacity; without one, or where
/// that is the same everywhere, it is its luminance as sRGB has it. Voxels of density 0 hold no data. `components` have a scalar at each voxel.
void showColors(Volume& volume, std::vector<ScalarBricks> components, SampleType type);

}  // namespace freevoxels
