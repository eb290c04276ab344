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
  SplatDrawing(const SplatDrawing&) = delete;
  SplatDrawing& operator=(const SplatDrawing&) = delete;

  struct Frame {
    Camera camera;
    FrameSettings settings;
    FrameConstants constants;
    std::shared_ptr<const FrameTargets> targets;
    const AttenuationTable* table = nullptr;  ///< where the frame reads it
  };
  /// Makes all that a frame needs before its blocks are listed and drawn. What is kept for further frames is made by submissions of its
  /// own, so that a frame that is abandoned leaves it complete.
  Frame prepare(const Camera& camera, const FrameSettings& settings, const Progress& progress);
  /// Records the sums, which are left in the frame's targets; for Sorted these are the image.
  void recordSums(Commands& commands, const Frame& frame);
  /// Records the image.
  std::shared_ptr<const FrameTargets> record(Commands& commands, const Frame& frame);
  /// The sums of a part's shares. The frame must not leave out hidden blocks. Waits for the device.
  FixedSums shares(const Frame& frame, const SharePart& part, const Progress& progress);

  /// To be called when a recorded frame is complete: the following functions are then of it, until another one is prepared or forget() is
  /// called.
  void complete() { drawn_ = recorded_; }
  void forget() { recorded_ = drawn_ = std::nullopt; }
  /// Drops what is kept of the scene's blocks.
  void reset();
  /// What became of the blocks; nothing without a frame. Reads back.
  CutCounts counts() const;
  /// The blocks that were drawn; null without a frame.
  const BlockList* drawnBlocks() const { return drawn_ ? drawn_->list : nullptr; }

 private:
  struct Drawn {
    const BlockList* list;
    std::optional<int> wholeLevel;  ///< the level, if these are all blocks of a level; else they are the list of `cut_`
  };
  void preparePasses(const FrameSettings& settings);
  SplatPass::Inputs recordList(Commands& commands, const Frame& frame, const CutCandidates* candidates = nullptr);

  DeviceScene& scene_;
  std::optional<CutPass> cut_;
  std::optional<SplatPass> splats_;
  std::optional<ResolvePass> resolve_;
  std::optional<DepthSort> sort_;
  std::optional<ShareDrawing> shares_;
  std::optional<Drawn> recorded_, drawn_;
};

}  // namespace freevoxels
