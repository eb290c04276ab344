#pragma once
// What a series of frames needs of a renderer, whether that holds the volume as a whole (renderer.h) or reads parts of it while it draws
// (region_renderer.h, streamed_renderer.h).

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/core/stages.h"
#include "engine/image/fixed_sums.h"
#include "engine/image/image.h"
#include "engine/memory_planner.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"
#include "engine/splatting/shares.h"
#include "engine/visibility/cut_pass.h"

namespace freevoxels {

/// Draws the frames of one volume on one device, which must outlive it.
class FrameRenderer {
 public:
  virtual ~FrameRenderer() = default;

  /// Draws a frame and waits for it. `progress` may abandon it by an exception, which is passed on. Fails with ErrorKind::OutOfMemory.
  virtual Image render(const Camera& camera, const FrameSettings& settings, const Progress& progress) = 0;

  /// Stage times of the constructor and of the last frame, in order.
  virtual std::vector<StageTime> timings() const = 0;
  /// Memory of the volume, or of the largest part of it that is held at a time.
  virtual VolumeMemory memory() const = 0;

  // Known only to a renderer that holds the whole volume.

  /// The number of occupied voxels, where it is known.
  virtual std::optional<std::uint64_t> occupiedVoxelCount() const { return {}; }
  /// The counts of the last frame's cut; none without one.
  virtual CutCounts cutCounts() const { return {}; }
  /// Whether the last frame used Bilinear for Auto only because the device lacks memory for rays from the eye.
  virtual bool lackedRoomForRays() const { return false; }
  /// Whether the last frame used Splats for Draw::Auto only because the device lacks memory for the gather.
  virtual bool lackedRoomForGather() const { return false; }
};

/// A renderer that can also draw some shares of a frame's blocks.
class ShareRenderer : public FrameRenderer {
 public:
  /// The sums of the shares of a part in fixed point: those of all parts add up to the same bits, however many parts there are, on
  /// devices of one kind. resolveSums makes the image. Fails with ErrorKind::OutOfMemory.
  virtual FixedSums renderShares(const Camera& camera, const FrameSettings& settings, const SharePart& part, const Progress& progress) = 0;
};

}  // namespace freevoxels
