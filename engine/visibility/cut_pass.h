#pragma once
// The list of blocks that a frame of splats draws, made on the device: Subr et al. 2007, Section 3.3.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/attenuation/attenuation_table.h"
#include "engine/octree/volume_builder.h"
#include "engine/visibility/cull_rule.h"
#include "engine/visibility/cut_candidates.h"
#include "engine/visibility/cut_counts.h"
#include "engine/visibility/detail_rule.h"

namespace freevoxels {

/// The input of a cut: the volume and the rules of the frame.
struct CutInputs {
  const DeviceVolume& volume;
  const BlockList& voxels;    ///< the occupied voxels
  const LevelLists& lists;        ///< the occupied blocks of the levels above
  const AttenuationTable* table;  ///< with its levels; null if CullRule::hiddenDepth is 0
  const shader::SetupFrame& setup;
  const DetailRule& detail;
  const CullRule& cull;
  const CutCandidates* candidates = nullptr;  ///< null: all blocks
};

/// COMPUTE cut_select.comp level by level from the coarsest, compact_scan.comp, cut_write.comp. Nothing is read back.
class CutPass {
 public:
  CutPass(const Device& device, AttenuationCode code);

  /// The list replaces that of the last frame, on which no work may be in progress.
  void record(Commands& commands, const CutInputs& inputs);
  /// The blocks to draw, level by level in a fixed order.
  const BlockList& blocks() const { return cut_; }
  /// An upper bound of the number of blocks.
  std::uint64_t mostBlocks() const { return mostBlocks_; }
  /// The counts of the last cut. Reads back.
  CutCounts counts() const;

 private:
  struct Level {
    const Buffer *parents, *children;  ///< children: those that are candidates, or null
    shader::CutPush push;
  };
  std::vector<Level> planLevels(const CutInputs& inputs);
  void makeRoom(const CutInputs& inputs);
  void recordSelect(Commands& commands, const CutInputs& inputs, std::span<const Level> levels);
  void recordList(Commands& commands, std::span<const Level> levels);
  std::vector<std::uint64_t> drawnByLevel() const;

  const Device& device_;
  AttenuationCode code_;
  Pipeline scan_, write_;
  Buffer frame_;                ///< shader::CutFrame
  Buffer opened_;               ///< a bit for each block above the voxels, as in cut_select.comp
  Buffer masks_;                ///< uint: a bit for each slot (cut_frame.glsl) of the levels that are drawn
  Buffer counts_;               ///< shader::CutCounts
  BlockList cut_;
  std::uint64_t mostBlocks_ = 0;
  int finest_ = 0;
  std::uint32_t groupCount_ = 0;            ///< number of workgroups of the levels that are drawn
  std::vector<std::uint32_t> firstGroups_;  ///< first workgroup of each level, starting with `finest_`
};

}  // namespace freevoxels
