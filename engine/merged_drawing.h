#pragma once
// Draws several volumes in one image by gathering: they attenuate and shadow each other, and their order changes no bit
// (gathering/merged_pass.h). Only engine/renderer*.cpp include it.

#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/device_scene.h"
#include "engine/gathering/merged_pass.h"
#include "engine/image/fixed_sums.h"
#include "engine/splatting/shares.h"
#include "engine/volume/scene_volume.h"

namespace freevoxels {

class MergedDrawing {
 public:
  /// Uploads the volumes, at most shader::kMaxMerged. Fails with ErrorKind::OutOfMemory, and with ErrorKind::Usage for more.
  MergedDrawing(const Device& device, std::vector<SceneVolume> volumes, const TableSettings& table, const Progress& progress);
  ~MergedDrawing();

  /// Draws a frame and waits for it. Fails with ErrorKind::Usage for splats, and for more lights than are evaluated at samples.
  std::shared_ptr<const FrameTargets> draw(const Camera& camera, const FrameSettings& settings, const Progress& progress);
  /// The sums of a part's rows of samples.
  FixedSums shares(const Camera& camera, const FrameSettings& settings, const SharePart& part, const Progress& progress);

  VolumeMemory memory() const;
  std::vector<StageTime> buildTimings() const;
  /// Stage times of the last frame.
  std::vector<StageTime> frameTimings() const;
  const ScatteringSolver* scattered() const { return scatters_ ? &*scattering_ : nullptr; }

 private:
  struct Medium;
  struct Frame {
    FrameSettings settings;
    std::vector<FrameConstants> constants = {};  ///< of each volume
    std::vector<shader::GatherFrame> rays = {};
    std::vector<MergedPass::Part> parts = {};
  };
  Frame prepare(const Camera& camera, const FrameSettings& settings, const Progress& progress);
  void solveScattering(const Lighting& lighting, int coarseness, const Progress& progress);
  void prepareRays(Medium& medium, const Camera& camera, Frame& frame, const Progress& progress);
  void prepareLights(Frame& frame, std::span<const Lighting> lightings, const Progress& progress);
  std::vector<ShadowingVolume> othersThan(const Medium& medium) const;
  void prepareVolume(std::size_t i, const Lighting* lighting, Frame& frame, const Progress& progress);
  void submit(Commands& commands, const Progress& progress);

  const Device& device_;
  std::deque<Medium> media_;  ///< in an order of their own
  std::optional<ScatteringSolver> scattering_;
  bool scatters_ = false;  ///< whether the last frame has scattered light
  MergedPass pass_;
  TargetPool targetPool_;
  std::vector<StageTime> times_;  ///< of the last frame, without those of the volumes
};

}  // namespace freevoxels
