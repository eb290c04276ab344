#pragma once
// The blocks that a frame draws, listed on the device: Subr et al. 2007, Section 3.3. In two parts, as what
// is hidden is known for sure only when what hides it is drawn.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/attenuation/attenuation_table.h"
#include "engine/octree/volume_builder.h"
#include "engine/visibility/cull_rule.h"
#include "engine/visibility/detail_rule.h"
#include "engine/visibility/tile_opacity_pass.h"

namespace freevoxels {

/// What a frame draws, and by what it chooses.
struct CutInputs {
  const DeviceVolume& volume;
  const BlockList& voxels;    ///< the list of level 0
  const LevelLists& lists;        ///< of the levels above
  const AttenuationTable* table;  ///< with its levels; null where CullRule::hiddenDepth is 0
  const shader::SetupFrame& setup;
  const shader::ResolvePush& rays;
  const DetailRule& detail;
  const CullRule& cull;
};

/// Counts of blocks of all levels: the coarsest, and those whose parent is neither drawn nor left out.
struct CutCounts {
  std::uint64_t considered = 0;      ///< the sum of the others
  std::uint64_t empty = 0;           ///< hold nothing
  std::uint64_t outside = 0;         ///< left out with all that is in them: no part of the image
  std::uint64_t hidden = 0;          ///< the same, behind others
  std::uint64_t opened = 0;          ///< their children were considered
  std::vector<std::uint64_t> drawn;  ///< by level, level 0 first
};

/// COMPUTE cut_select.comp level by level from the coarsest, compact_scan.comp, cut_write.comp; after the
/// first drawing tile_opacity.comp and the same again for what the table calls hidden. Nothing is read back.
class CutPass {
 public:
  CutPass(const Device& device, AttenuationCode code);

  /// Lists the blocks to draw first. They replace those of the last frame, on which no work may be under way.
  void record(Commands& commands, const CutInputs& inputs);
  /// Lists those that remain, behind the first: the sums of the first are in the targets, in layout GENERAL.
  void recordDeferred(Commands& commands, const CutInputs& inputs, const RenderTarget& colorEnergy,
                      const RenderTarget& opticalDepth);
  /// Level by level in a fixed order. The first half of the chunks is for the first drawing.
  const BlockList& blocks() const { return cut_; }
  /// Of the last cut. Reads back.
  CutCounts counts() const;

 private:
  struct Level {
    const Buffer* parents;
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
  std::array<std::array<Pipeline, 2>, 2> select_;  ///< by Part, and whether of the voxels
  Pipeline scan_, write_;
  TileOpacityPass cover_;
  Buffer frame_;                ///< shader::CutFrame
  Buffer children_, deferred_;  ///< a byte a block above the voxels: as in cut_select.comp
  Buffer masks_;                ///< uint: a bit a slot (candidate_slot.glsl) of the levels that are drawn
  Buffer counts_;               ///< shader::CutCounts
  BlockList cut_;           ///< groupOffsets twice, a part behind the other, each with its total
  int finest_ = 0;
  std::uint32_t groupCount_ = 0;  ///< of the levels that are drawn
  bool hasDeferred_ = false;
  std::vector<std::uint32_t> firstGroups_;  ///< of the levels from `finest_` on
};

}  // namespace freevoxels
