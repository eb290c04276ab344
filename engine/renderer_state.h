#pragma once
// What a Renderer keeps between frames of a volume that is on the device as a whole. Only renderer*.cpp include it.

#include "engine/gather_drawing.h"
#include "engine/renderer.h"
#include "engine/splat_drawing.h"
#include "engine/vulkan/target_readback.h"

namespace freevoxels {

struct Renderer::State {
  DeviceScene scene;
  GatherDrawing gather{scene};
  SplatDrawing splats{scene};
  bool drewSplats = false;  ///< whether the last frame was of splats
  TargetReadback colorReadback, distanceReadback;

  /// Records the image of a frame.
  std::shared_ptr<const FrameTargets> record(Commands& commands, const Camera& camera, const FrameSettings& settings,
                                             const Progress& progress) {
    drewSplats = !settings.gathers();
    if (drewSplats) return splats.record(commands, splats.prepare(commands, camera, settings, progress));
    return gather.record(commands, gather.prepare(camera, settings, progress));
  }
  FixedSums shares(const Camera& camera, const FrameSettings& settings, const SharePart& part, const Progress& progress) {
    drewSplats = !settings.gathers();
    if (!drewSplats) return gather.shares(gather.prepare(camera, settings, progress), part, progress);
    Commands commands(scene.device);
    SplatDrawing::Frame frame = splats.prepare(commands, camera, settings, progress);
    return splats.shares(commands, std::move(frame), part, progress);
  }
};

}  // namespace freevoxels
