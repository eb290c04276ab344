#pragma once
// The steps by which the octree is built from the voxels upwards: each computes a level from the one below.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/octree/block_list.h"
#include "engine/octree/device_volume.h"
#include "engine/vulkan/pipeline.h"

namespace freevoxels {

/// A level is small if it has at most this many occupancy words: one workgroup computes it in about the time that a dispatch on a GPU waits
/// for the one before it.
constexpr std::uint64_t kSmallLevelWords = 32;

/// Whether the small levels at the top of an octree have a dispatch each, or one that computes them one after the other.
enum class LevelDispatches { Single, Joined };

/// The faster way of a device: GPUs wait at each barrier, CPUs would compile more pipelines.
LevelDispatches levelDispatches(const Device& device);

/// The levels of each dispatch, from fine to coarse; all those above the voxels.
std::vector<shader::LevelRange> levelRanges(const HierarchyLayout& hierarchy, LevelDispatches dispatches);

/// The pipelines of a pass that computes levels.
struct LevelPipelines {
  LevelDispatches dispatches = LevelDispatches::Single;
  Pipeline fromVoxels, fromBlocks;  ///< for one level
  Pipeline joined;                  ///< for several levels, one workgroup in each layer; only with LevelDispatches::Joined

  static bool isJoined(shader::LevelRange levels) { return levels.end - levels.first > 1; }
  const Pipeline& of(shader::LevelRange levels) const { return isJoined(levels) ? joined : levels.first == 1 ? fromVoxels : fromBlocks; }
  /// The threads to dispatch for levels of which the first has `parts` parts, a thread each.
  static std::uint64_t threads(shader::LevelRange levels, std::uint64_t parts) { return isJoined(levels) ? 1 : parts; }
};

/// A uniform buffer for uploadLevelSteps().
Buffer makeLevelSteps(const Device& device);
/// Uploads the steps to the levels above the voxels, for shaders/level_steps.glsl: a shader::LevelStep for each level. `coarse` lists the
/// blocks of levels 1, 2, ...; empty before they are listed.
void uploadLevelSteps(const Device& device, const Buffer& steps, const DeviceVolume& volume, std::span<const BlockList> coarse);

}  // namespace freevoxels
