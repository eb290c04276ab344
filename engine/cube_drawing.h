#pragma once
// Draws a volume that does not fit into the device's memory by gathering: Subr et al. 2007, Section 5. Cubes of the volume are read from
// its source one after the other, in the order in which rays meet them, and each ray continues in the next cube with the sums and the
// transmittance that the cubes in front of it left. Positions on rays are those in the whole volume, so that the image is the one that is
// gathered with all voxels in memory, up to rounding and to the samples that are interpolated there, and has the same bits with every
// memory limit. Only renderer.cpp includes this.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/cube_level.h"
#include "engine/image/fixed_sums.h"
#include "engine/memory_planner.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"
#include "engine/splatting/frame_targets.h"
#include "engine/splatting/shares.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume_source.h"

namespace freevoxels {

class ScatteringSolver;

class CubeDrawing {
 public:
  /// Cubes are read with this number of voxels around them: enough for the light of surfaces, and whole bricks.
  static constexpr int kHalo = 8;

  /// Why frames of a volume cannot be drawn cube by cube, as a clause; nothing if they can.
  static std::optional<std::string> whyNot(const FrameSettings& settings);

  /// Frames must be such that whyNot() has no reason.
  CubeDrawing(const Device& device, std::shared_ptr<const VolumeSource> source, const Classification& classification,
              const TableSettings& table);
  ~CubeDrawing();

  /// The image of a frame, which is complete. Light that reaches voxels is kept for further frames. Fails with ErrorKind::OutOfMemory where
  /// one cube does not fit.
  std::shared_ptr<const FrameTargets> draw(const Camera& camera, const FrameSettings& settings, const Progress& progress);
  /// The sums of a part's rows of samples. Those of all parts add up to the same bits, however many parts there are.
  FixedSums drawShares(const Camera& camera, const FrameSettings& settings, const SharePart& part, const Progress& progress);

  /// `error`, with which a frame failed for lack of memory; or, where a limit is less than the device's memory, a sentence with the memory
  /// that the frame needs.
  Error withNeed(const Error& error, const Camera& camera, const FrameSettings& settings) const;

  /// Stage times of the last frame, with those of the light that it swept.
  const std::vector<StageTime>& timings() const;
  /// The light of frames that have it; null if none had.
  const ScatteringSolver* scattered() const;
  /// Memory of a cube.
  VolumeMemory memory() const;
  /// How many cubes the last frame read, by level.
  const std::vector<std::size_t>& cubesRead() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace freevoxels
