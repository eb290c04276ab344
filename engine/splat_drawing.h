#pragma once
// Draws a volume that is on the device as a whole by splats: the method of Subr et al. 2007. Only engine/renderer*.cpp include it.

#include <memory>
#include <optional>

#include "engine/device_scene.h"
#include "engine/image/fixed_sums.h"
#include "engine/scene/camera.h"
#include "engine/splatting/depth_sort.h"
#include "engine/splatting/resolve_pass.h"
#include "engine/splatting/share_drawing.h"
#include "engine/splatting/splat_pass.h"
#include "engine/visibility/cut_pass.h"

namespace freevoxels {

class SplatDrawing {
 public:
  /// Frames are of `scene`, which must outlive the drawing.
  explicit SplatDrawing(DeviceScene& scene) : scene_(scene) {}

  struct Frame {
    FrameSettings settings;
    FrameConstants constants;
    std::shared_ptr<const FrameTargets> targets;
    const AttenuationTable* table = nullptr;    ///< where the frame reads it
    const Buffer* order = nullptr;              ///< of the voxels, where they are sorted
    const CutCandidates* candidates = nullptr;  ///< of a frame that draws some shares only
    bool isCut() const { return !constants.detail.isOneLevel() || !constants.cull.leavesNothingOut(); }
  };
  /// Makes all that a frame needs before its blocks are listed and drawn, and records its depth sort.
  Frame prepare(Commands& commands, const Camera& camera, const FrameSettings& settings, const Progress& progress);
  /// Records the sums, which are left in the frame's targets; for Sorted these are the image.
  void recordSums(Commands& commands, const Frame& frame);
  /// Records the image.
  std::shared_ptr<const FrameTargets> record(Commands& commands, const Frame& frame);
  /// The sums of a part's shares. The frame must not leave out hidden blocks. Submits `commands` and waits for the device.
  FixedSums shares(Commands& commands, Frame frame, const SharePart& part, const Progress& progress);

  /// Of the last frame that was not sorted; nothing and null before the first.
  CutCounts counts() const;
  const BlockList* lastDrawn() const { return lastDrawn_; }

 private:
  void preparePasses(const FrameSettings& settings);
  SplatPass::Inputs recordList(Commands& commands, const Frame& frame);

  DeviceScene& scene_;
  std::optional<CutPass> cut_;
  std::optional<SplatPass> splats_;
  std::optional<ResolvePass> resolve_;
  std::optional<DepthSort> sort_;
  std::optional<ShareDrawing> shares_;
  const BlockList* lastDrawn_ = nullptr;
  bool lastWasCut_ = false;  ///< whether lastDrawn_ is the list of `cut_`
  int lastLevel_ = 0;        ///< otherwise the level of all drawn blocks
};

}  // namespace freevoxels
