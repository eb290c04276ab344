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
  TargetReadback colorReadback, distanceReadback;

  bool reclassify(const Classification& other) {
    if (!scene.reclassify(other)) return false;
    gather.reclassify();
    splats.reset();
    return true;
  }

  /// Records the image of a frame, which is complete after submit().
  std::shared_ptr<const FrameTargets> record(Commands& commands, const Camera& camera, const FrameSettings& settings,
                                             const Progress& progress) {
    splats.forget();
    if (settings.gathers()) return gather.record(commands, gather.prepare(camera, settings, progress));
    return splats.record(commands, splats.prepare(camera, settings, progress));
  }
  void submit(Commands& commands, const Progress& progress = {}) {
    scene.submit(commands, progress);
    splats.complete();
  }
  FixedSums shares(const Camera& camera, const FrameSettings& settings, const SharePart& part, const Progress& progress) {
    splats.forget();
    if (settings.gathers()) return gather.shares(gather.prepare(camera, settings, progress), part, progress);
    FixedSums sums = splats.shares(splats.prepare(camera, settings, progress), part, progress);
    splats.complete();
    return sums;
  }
};

}  // namespace freevoxels
