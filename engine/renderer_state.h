#pragma once
// What a Renderer keeps between frames of a volume that is on the device as a whole, and the stages of a frame. Only renderer*.cpp include
// it.

#include <memory>
#include <optional>
#include <vector>

#include "engine/attenuation/attenuation_table.h"
#include "engine/attenuation/table_levels.h"
#include "engine/gathering/gather_pass.h"
#include "engine/gathering/gather_rows.h"
#include "engine/lighting/light_pass.h"
#include "engine/octree/block_list.h"
#include "engine/octree/device_volume.h"
#include "engine/renderer.h"
#include "engine/splatting/depth_sort.h"
#include "engine/splatting/resolve_pass.h"
#include "engine/splatting/share_drawing.h"
#include "engine/splatting/splat_pass.h"
#include "engine/splatting/sums_readback.h"
#include "engine/visibility/cut_pass.h"
#include "engine/vulkan/target_readback.h"

namespace freevoxels {

struct Renderer::State {
  const Device& device;
  const Volume& hostVolume;
  Classification classification;
  TableSettings tableSettings;
  BuiltVolume built;
  std::optional<AttenuationTable> table;
  std::vector<double> largestDepths;  ///< of the table, by direction; empty if it has no levels yet
  std::optional<CutPass> cutter;
  const BlockList* lastDrawn = nullptr;
  bool lastWasCut = false;  ///< whether lastDrawn is the list of `cutter`
  int lastLevel = 0;        ///< otherwise the level of all drawn blocks
  bool lastLackedRays = false;
  std::unique_ptr<SplatPass> splats;
  std::unique_ptr<ResolvePass> resolve;
  std::unique_ptr<DepthSort> sort;
  std::unique_ptr<ShareDrawing> shares;
  std::optional<GatherVolume> gatherVolume;
  std::optional<GatherPass> gather;
  std::optional<LightPass> lights;
  TargetPool targetPool;
  TargetReadback colorReadback, distanceReadback;
  std::vector<StageTime> buildTimes, frameTimes;

  struct Splatting {
    FrameConstants constants;
    std::shared_ptr<const FrameTargets> targets;
    const AttenuationTable* table = nullptr;  ///< where the frame reads it
    const Buffer* order = nullptr;            ///< of the voxels, where they are sorted
    const CutCandidates* candidates = nullptr;  ///< of a frame that draws some shares only
    bool isCut() const { return !constants.detail.isOneLevel() || !constants.cull.leavesNothingOut(); }
  };
  VolumeMemory memoryOfVolume() const;
  const BuiltVolume& builtWithBlocks(const Progress& progress = {});
  const AttenuationTable& sweptTable(const Progress& progress = {});
  const AttenuationTable& tableWithLevels(const Progress& progress = {});
  SplatPass::Inputs recordList(Commands& commands, const Splatting& frame);
  CutInputs cutInputs(const Splatting& frame) const;
  void recordDrawing(Commands& commands, const Splatting& frame);
  FrameSettings resolved(const FrameSettings& settings);
  FrameConstants constantsOf(const Camera& camera, const FrameSettings& settings, const Progress& progress);
  Splatting prepareSplats(Commands& commands, const Camera& camera, const FrameSettings& settings, const Progress& progress);
  Splatting recordSplats(Commands& commands, const Camera& camera, const FrameSettings& settings, const Progress& progress = {});
  struct Gathering {
    FrameSettings settings;
    FrameConstants constants;
    shader::GatherFrame lattice;
  };
  Gathering prepareGather(const Camera& camera, const FrameSettings& wanted, const Progress& progress);
  void prepareVolume(const GatherVolume::Shading& shading, const Progress& progress);
  std::shared_ptr<const FrameTargets> recordGather(Commands& commands, const Camera& camera, const FrameSettings& settings,
                                                   const Progress& progress);
  std::shared_ptr<const FrameTargets> recordImage(Commands& commands, const Camera& camera, const FrameSettings& settings,
                                                  const Progress& progress);
  FixedSums gatherShares(const Camera& camera, const FrameSettings& settings, const SharePart& part, const Progress& progress);
  FixedSums splatShares(const Camera& camera, const FrameSettings& settings, const SharePart& part, const Progress& progress);
};

}  // namespace freevoxels
