#include "engine/octree/level_steps.h"

namespace freevoxels {

LevelDispatches levelDispatches(const Device& device) {
  return device.isCpu() ? LevelDispatches::Single : LevelDispatches::Joined;
}

std::vector<shader::LevelRange> levelRanges(const HierarchyLayout& hierarchy, LevelDispatches dispatches) {
  std::vector<shader::LevelRange> ranges;
  for (int level = 1; level <= hierarchy.top(); level = ranges.back().end) {
    // Level 1 has pipelines of its own, as its children are voxels.
    const bool joined = dispatches == LevelDispatches::Joined && level > 1 && hierarchy.words(level) <= kSmallLevelWords;
    ranges.push_back({.first = level, .end = joined ? hierarchy.top() + 1 : level + 1});
  }
  return ranges;
}

Buffer makeLevelSteps(const Device& device) {
  return Buffer(device, shader::kMaximumLevels * sizeof(shader::LevelStep), MemoryUse::Device, "octree steps",
                VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
}

void uploadLevelSteps(const Device& device, const Buffer& steps, const DeviceVolume& volume, std::span<const BlockList> coarse) {
  std::vector<shader::LevelStep> values(volume.hierarchy.levels.size());
  for (int level = 1; level <= volume.hierarchy.top(); ++level) {
    shader::LevelStep& step = values[std::size_t(level)];
    step.child = volume.onDevice(level - 1);
    step.parent = volume.onDevice(level);
    step.parentWords = std::uint32_t(volume.hierarchy.words(level));
    step.childEdge = Block{.level = level - 1}.edge();
    if (coarse.empty()) continue;
    step.parents = addressWords(coarse[std::size_t(level) - 1].indices.address());
    step.parentCount = std::uint32_t(volume.stored[std::size_t(level)]);
  }
  upload(device, steps, std::as_bytes(std::span(values)));
}

}  // namespace freevoxels
