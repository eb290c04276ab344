#pragma once
// Draws a volume that is on the device as a whole by gathering (engine/docs/gather.md). Only engine/renderer*.cpp include it.

#include <memory>
#include <optional>

#include "engine/device_scene.h"
#include "engine/gathering/gather_pass.h"
#include "engine/image/fixed_sums.h"
#include "engine/scene/camera.h"
#include "engine/splatting/frame_constants.h"
#include "engine/splatting/shares.h"

namespace freevoxels {

class GatherDrawing {
 public:
  /// Frames are of `scene`, which must outlive the drawing. What it keeps of the volume is made for the first of them.
  explicit GatherDrawing(DeviceScene& scene) : scene_(scene) {}
  GatherDrawing(const GatherDrawing&) = delete;
  GatherDrawing& operator=(const GatherDrawing&) = delete;

  struct Frame {
    FrameSettings settings;
    FrameConstants constants;
    shader::GatherFrame lattice;  ///< of the image's samples
  };
  /// Makes all that a frame needs before its samples are marched. What is kept for further frames is made by submissions of its own, so
  /// that a frame that is abandoned leaves it complete.
  Frame prepare(const Camera& camera, const FrameSettings& settings, const Progress& progress);
  /// Records the image; the targets have no optical depth.
  std::shared_ptr<const FrameTargets> record(Commands& commands, const Frame& frame);
  /// The sums of a part's rows of samples. Waits for the device.
  FixedSums shares(const Frame& frame, const SharePart& part, const Progress& progress);

  /// Says that DeviceScene::reclassify() has changed the scene.
  void reclassify() { isOld_ = true; }

  /// After the first frame.
  const GatherVolume& volume() const { return *volume_; }
  GatherPass& pass() { return *pass_; }

 private:
  void followScene(const GatherVolume::Shading& shading);
  void prepareVolume(const GatherVolume::Shading& shading, const shader::GatherFrame& lattice, const Progress& progress);

  DeviceScene& scene_;
  std::optional<GatherVolume> volume_;
  bool isOld_ = false;  ///< whether volume_ has not followed the scene's classification yet
  int codesVersion_ = 0;  ///< DeviceScene::codesVersion() of volume_
  std::optional<GatherPass> pass_;
};

}  // namespace freevoxels
