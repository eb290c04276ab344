#pragma once
// The stages that freevoxels-bench measures, with the device's clock.

#include <string_view>
#include <vector>

#include "apps/bench/measure.h"
#include "engine/description/scene_description.h"
#include "engine/scene/directions.h"
#include "engine/validation/quality_scenes.h"
#include "engine/vulkan/device.h"

namespace freevoxels::bench {

/// The sweeps for all D directions of a set over a volume of N³ voxels, compared with a copy of (D + 1) N³
/// bytes.
Result sweeps(const Device& device, DirectionSet directions, int resolution, int runs);

/// A volume of which six of seven voxels are occupied, and differ from their neighbours.
inline constexpr std::string_view kStripes = "stripes";

/// The octree's levels above the voxels of kStripes or a procedural volume, compared with a copy of 27 bytes
/// for each occupied voxel. The name has the ratio to the 26 sweeps.
Result octree(const Device& device, std::string_view name, AttenuationCode code, int resolution, int runs);

/// Choosing, setting up and drawing the blocks of a cloud of N³ voxels from near to far, without and with
/// level of detail.
std::vector<Result> zoom(const Device& device, int resolution, int runs);

/// Choosing, setting up and drawing the voxels of a head of N³ voxels, without and with culling.
std::vector<Result> culling(const Device& device, QualityColor color, int resolution, int runs);

/// A frame of a turntable of a head or a cloud of N³ voxels at 1024 x 1024 pixels, in memory: gathered and by
/// splats, without lights and with one. Everything that frames share is made before.
std::vector<Result> frames(const Device& device, std::string_view name, int resolution, int runs);

/// A frame of a turntable of a head or a cloud of N³ voxels, in memory: the mean of 12 cameras that are 5
/// degrees apart, without the first. All lights are directional.
Result turntable(const Device& device, std::string_view name, int resolution, glm::ivec2 size, int lights, int runs);

/// A cloud of N³ voxels, from memory to a lit image of 1024 x 1024 pixels in memory: with one light and 16
/// lights shadowed by the table, and with the number that Auto shadows exactly.
std::vector<Result> lights(const Device& device, int resolution, int runs);

/// The list of occupied voxels of a volume of N³ voxels, of which a thirtieth is occupied, compared with a
/// copy of 4 N³ bytes.
Result compaction(const Device& device, int resolution, int runs);

/// Half a million splats of `pixels` x `pixels` in 1024 x 1024 pixels; reports splats a second.
Result splats(const Device& device, double pixels, int runs);

/// A whole render from a volume in memory to the image in memory, at 1024 x 1024 pixels.
Result wholeRender(const Device& device, const InputDescription& input, bool lit, int runs);

/// A whole render of a dense scan of N³ voxels: 8-bit scalars with a transfer function.
Result wholeScan(const Device& device, int resolution, bool lit, int runs);

/// What a user waits for who turns a transfer function of a dense scan of N³ voxels, at 1280 x 800 pixels with one light: a draft of 1/5 of
/// the edges' pixels with the light that there was, and the whole image; and small frames.
std::vector<Result> edits(const Device& device, int resolution, int runs);

/// A frame of a flight through procedural:cloud at `resolution`³ at 512 x 512 pixels: the mean of frames with
/// the eye outside the box, and of those with the eye inside. The table is made before.
std::vector<Result> flight(const Device& device, int resolution, int runs);

}  // namespace freevoxels::bench
