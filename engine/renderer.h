#pragma once
// Volume in, image out: the passes of engine/docs/method.md in their order.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "engine/frame_renderer.h"
#include "engine/octree/hierarchy_layout.h"
#include "engine/splatting/frame_targets.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// The image of a frame that was left on the device. Waits.
Image downloadImage(const Device& device, const FrameTargets& targets);

/// A stage of renderShares, once for a part: the list of the blocks that it has to look at.
inline constexpr const char* kChoosingShares = "choose blocks of shares";

class Renderer : public ShareRenderer {
 public:
  /// Uploads the volume, which must outlive the renderer, and makes what every frame needs: classified blocks
  /// and their lists, or for a volume that is classified after interpolation its scalars; the blocks are then
  /// made for the first frame that needs them for lights, levels of detail or splats. The attenuation table
  /// is made for the first frame that reads it, its levels for the first that may draw or leave out blocks.
  /// Fails with ErrorKind::OutOfMemory, before allocating, if the device's limits are too small.
  Renderer(const Device& device, const Volume& volume, const Classification& classification,
           const TableSettings& table, const Progress& progress = {});
  Renderer(const Device&, Volume&&, const Classification&, const TableSettings&, const Progress& = {}) = delete;
  ~Renderer() override;

  /// Draws a frame and waits for it. `progress` is called about every 50 ms, and may abandon the frame by an exception, which
  /// is passed on; the next frame makes again what was not complete.
  Image render(const Camera& camera, const FrameSettings& settings, const Progress& progress = {}) override;
  /// The same frame, which stays on the device, complete, in layout GENERAL. The renderer draws into these targets again
  /// when nobody else holds them.
  std::shared_ptr<const FrameTargets> renderOnDevice(const Camera& camera, const FrameSettings& settings, const Progress& progress = {});

  /// Drawn as render() would, by gathering or by splats, with nothing left out as hidden. `settings.composite` must not be Sorted.
  FixedSums renderShares(const Camera& camera, const FrameSettings& settings, const SharePart& part,
                         const Progress& progress = {}) override;

  /// Including the table even if no frame has read it.
  VolumeMemory memory() const override;
  std::vector<StageTime> timings() const override;
  /// Unknown until a frame needs the blocks of occupied voxels.
  std::optional<std::uint64_t> occupiedVoxelCount() const override;
  CutCounts cutCounts() const override;
  bool lackedRoomForRays() const override;
  bool lackedRoomForGather() const override;

 private:
  friend class RendererStages;  // renderer_stages.h
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace freevoxels
