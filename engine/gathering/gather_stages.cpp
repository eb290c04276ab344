#include "engine/gathering/gather_stages.h"

#include "engine/gathering/gather_pass.h"
#include "engine/octree/medium_levels.h"

namespace freevoxels {

GatherStages downloadGatherStages(const Device& device, const BuiltVolume& built, const GatherVolume& volume, const GatherPass& pass) {
  GatherStages stages{.lattice = pass.lattice(),
                      .medium = {},
                      .blocks = volume.downloadBlocks(),
                      .light = volume.downloadLight(),
                      .scattered = volume.downloadScattered(),
                      .gathered = pass.downloadGathered(),
                      .smoothed = volume.hasScalars() ? std::vector<GatherSums>() : pass.downloadSmoothed(),
                      .image = {}};
  for (std::size_t level = 0; level < stages.blocks.size(); ++level)
    stages.medium.push_back(stages.blocks[level].exists() ? downloadMedium(device, built.volume, int(level)) : LevelData());
  return stages;
}

}  // namespace freevoxels
