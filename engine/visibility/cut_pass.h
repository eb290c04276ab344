#pragma once
// The list of blocks that a frame draws, made on the device: Subr et al. 2007, Section 3.3. Two-phase
// occlusion culling: the blocks that the table calls hidden are deferred until the others are drawn, as only
// then it is known which pixels they can still change.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/attenuation/attenuation_table.h"
#include "engine/octree/volume_builder.h"
#include "engine/visibility/cull_rule.h"
#include "engine/visibility/cut_candidates.h"
#include "engine/visibility/detail_rule.h"
#include "engine/visibility/tile_opacity_pass.h"

namespace freevoxels {

/// The input of a cut: the volume and the rules of the frame.
struct CutInputs {
  const DeviceVolume& volume;
  const BlockList& voxels;    ///< the occupied voxels
  const LevelLists& lists;        ///< the occupied blocks of the levels above
  const AttenuationTable* table;  ///< with its levels; null if CullRule::hiddenDepth is 0
  const shader::SetupFrame& setup;
  const shader::ResolvePush& rays;
  const DetailRule& detail;
  const CullRule& cull;
  const CutCandidates* candidates = nullptr;  ///< null: all blocks. Only for the first phase.
};

/// Numbers of blocks of all levels that were considered: those of the coarsest level, and those whose parent
/// was opened.
struct CutCounts {
  std::uint64_t considered = 0;      ///< the sum of the others
  std::uint64_t empty = 0;           ///< not occupied
  std::uint64_t outside = 0;         ///< left out with all blocks in them: outside of the image
  std::uint64_t hidden = 0;          ///< left out with all blocks in them: hidden by others
  std::uint64_t opened = 0;          ///< replaced by their children
  std::vector<std::uint64_t> drawn;  ///< number of drawn blocks by level, level 0 first
};

/// COMPUTE cut_select.comp level by level from the coarsest, compact_scan.comp, cut_write.comp. After the
/// first drawing, tile_opacity.comp and the same passes for the deferred blocks. Nothing is read back.
class CutPass {
 public:
  CutPass(const Device& device, AttenuationCode code);

  /// Records the first phase. Its list replaces that of the last frame, on which no work may be in progress.
  void record(Commands& commands, const CutInputs& inputs);
  /// Records the second phase, which appends the deferred blocks that can still be seen. The targets, in
  /// layout GENERAL, hold the sums of the first phase.
  void recordDeferred(Commands& commands, const CutInputs& inputs, const RenderTarget& colorEnergy,
                      const RenderTarget& opticalDepth);
  /// The blocks to draw, level by level in a fixed order. The first half of the chunks belongs to the first
  /// phase.
  const BlockList& blocks() const { return cut_; }
  /// An upper bound of the number of blocks of the first phase.
  std::uint64_t mostBlocks() const { return mostBlocks_; }
  /// The counts of the last cut. Reads back.
  CutCounts counts() const;

 private:
  struct Level {
    const Buffer *parents, *children;  ///< children: those that are candidates, or null
    shader::CutPush push;
  };
  enum class Part : std::uint32_t { First, Deferred };
  std::vector<Level> planLevels(const CutInputs& inputs, Part part);
  void makeRoom(const CutInputs& inputs);
  void recordPart(Commands& commands, const CutInputs& inputs, Part part);
  void recordSelect(Commands& commands, const CutInputs& inputs, std::span<const Level> levels, Part part);
  void recordList(Commands& commands, std::span<const Level> levels, Part part);
  std::vector<std::uint64_t> drawnByLevel() const;

  const Device& device_;
  AttenuationCode code_;
  std::array<std::array<Pipeline, 2>, 2> select_;  ///< by Part, and for blocks or voxels
  std::array<Pipeline, 2> selectCandidates_;       ///< the first phase among candidates, made when it is first needed
  Pipeline scan_, write_;
  TileOpacityPass cover_;
  Buffer frame_;                ///< shader::CutFrame
  Buffer children_, deferred_;  ///< a byte for each block above the voxels, as in cut_select.comp
  Buffer masks_;                ///< uint: a bit for each slot (candidate_slot.glsl) of the levels that are drawn
  Buffer counts_;               ///< shader::CutCounts
  BlockList cut_;           ///< has groupOffsets for both parts, one after the other, each with its total
  std::uint64_t mostBlocks_ = 0;
  int finest_ = 0;
  std::uint32_t groupCount_ = 0;  ///< number of workgroups of the levels that are drawn
  bool hasDeferred_ = false;
  std::vector<std::uint32_t> firstGroups_;  ///< first workgroup of each level, starting with `finest_`
};

}  // namespace freevoxels
