#pragma once
// The blocks that a frame draws, listed on the device: Subr et al. 2007, Section 3.3.

#include <cstdint>
#include <vector>

#include "engine/hierarchy/detail_rule.h"
#include "engine/hierarchy/level_passes.h"

namespace freevoxels {

/// COMPUTE cut_select.comp, visible_scan.comp, cut_write.comp: level by level, and nothing is read back.
class CutPass {
 public:
  explicit CutPass(const Device& device);

  /// The blocks to draw by a rule of several levels, level by level in ascending order. They replace those of
  /// the last frame, on which no work may be under way. `voxels` is the list of level 0.
  const VisibleVoxels& record(Commands& commands, const DeviceVolume& volume, const VisibleVoxels& voxels,
                              const LevelLists& lists, const DetailRule& rule);
  /// Of the last cut, level 0 first. Reads back.
  std::vector<std::uint64_t> countDrawn() const;

 private:
  struct Level {
    const Buffer* blocks;
    shader::CutPush push;
  };
  std::vector<Level> levelsOf(const DeviceVolume& volume, const VisibleVoxels& voxels,
                              const LevelLists& lists, const DetailRule& rule) const;
  void makeRoom(std::uint64_t groups, std::uint64_t mostDrawn);

  const Device& device_;
  Pipeline select_, scan_, write_;
  Buffer masks_;  ///< uint: a bit a block
  VisibleVoxels cut_;
  int finest_ = 0;
  std::uint32_t groupCount_ = 0;
  std::vector<std::uint32_t> firstGroups_;  ///< of the levels from `finest_` on
};

}  // namespace freevoxels
