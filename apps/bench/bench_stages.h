#pragma once
// The stages that freevoxels-bench measures, each by the device's own clock.

#include <string_view>
#include <vector>

#include "apps/bench/measure.h"
#include "apps/freevoxels/input_options.h"
#include "engine/scene/directions.h"
#include "engine/validation/quality_scenes.h"
#include "engine/vulkan/device.h"

namespace freevoxels::bench {

/// The sweeps for all D directions of a set over an N³ volume, beside a copy of (D + 1) N³ bytes.
Result sweeps(const Device& device, DirectionSet directions, int resolution, int runs);

/// A volume of which six of seven voxels hold anything, unlike their neighbours.
inline constexpr std::string_view kStripes = "stripes";

/// The octree's levels above the voxels of kStripes or a procedural volume, beside a copy of 27 bytes for
/// each that holds anything; the name has the ratio to the 26 sweeps.
Result octree(const Device& device, std::string_view name, AttenuationCode code, int resolution, int runs);

/// Choosing, setting up and drawing the blocks of a cloud of N³ voxels from near to far, without and with
/// level of detail.
std::vector<Result> zoom(const Device& device, int resolution, int runs);

/// Choosing, setting up and drawing the voxels of a head of N³ voxels, all of them and culled.
std::vector<Result> culling(const Device& device, QualityColor color, int resolution, int runs);

/// A frame of a turntable of a head or a cloud of N³ voxels at 1024 x 1024 pixels, in memory, by gathering and by splats,
/// without lights and with one. What is made once is made before.
std::vector<Result> frames(const Device& device, std::string_view name, int resolution, int runs);

/// A frame of a turntable of a head or a cloud of N³ voxels, in memory: the mean of 12 cameras, 5 degrees from each other,
/// after the first. Each light is directional.
Result turntable(const Device& device, std::string_view name, int resolution, glm::ivec2 size, int lights, int runs);

/// A cloud of N³ voxels, from memory to a lit picture of 1024 x 1024 pixels in memory: with one light and 16
/// that the table shadows, and with as many as Auto shadows exactly.
std::vector<Result> lights(const Device& device, int resolution, int runs);

/// The list of visible voxels of an N³ volume of which a thirtieth is visible, beside a copy of 4 N³ bytes.
Result compaction(const Device& device, int resolution, int runs);

/// Half a million splats of `pixels` x `pixels` into 1024 x 1024 pixels; splats a second.
Result splats(const Device& device, double pixels, int runs);

/// Everything from a volume in memory to the picture in memory, at 1024 x 1024 pixels.
Result wholeRender(const Device& device, const InputOptions& input, bool lit, int runs);

/// The same of a dense scan of N³ voxels: 8-bit scalars with a transfer function.
Result wholeScan(const Device& device, int resolution, bool lit, int runs);

/// A frame of a flight through procedural:cloud at `resolution`³ at 512 x 512 pixels: the mean of those with
/// the eye outside the box, and of those with the eye inside. The table is made before.
std::vector<Result> flight(const Device& device, int resolution, int runs);

}  // namespace freevoxels::bench
