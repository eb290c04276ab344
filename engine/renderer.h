#pragma once
// Volume in, image out.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/stages.h"
#include "engine/image/fixed_sums.h"
#include "engine/image/image.h"
#include "engine/memory_planner.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"
#include "engine/scene/scattered_field.h"
#include "engine/splatting/frame_targets.h"
#include "engine/splatting/shares.h"
#include "engine/visibility/cut_counts.h"
#include "engine/volume/classification.h"
#include "engine/volume/scene_volume.h"
#include "engine/volume/volume_source.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

class CubeDrawing;
class MergedDrawing;

/// Draws the frames of one volume, or of several together, on one device, which must outlive it. The volume is on the device as a whole
/// where that fits; otherwise gathered frames are drawn cube by cube (cube_drawing.h), and others fail with ErrorKind::OutOfMemory and a
/// sentence with what they need.
class Renderer {
 public:
  /// Uploads the volume if it fits, and makes what every frame needs: classified blocks and their lists, or for a volume that is
  /// classified after interpolation its scalars; the blocks are then made for the first frame that needs them for lights, levels of detail
  /// or splats. The attenuation table is made for the first frame that reads it, its levels for the first that may draw or leave out
  /// blocks.
  Renderer(const Device& device, std::shared_ptr<const VolumeSource> source, const Classification& classification,
           const TableSettings& table, const Progress& progress = {});
  /// The same for a volume that is in memory; it must outlive the renderer.
  Renderer(const Device& device, const Volume& volume, const Classification& classification, const TableSettings& table,
           const Progress& progress = {});
  /// Draws one or more volumes, which attenuate and shadow each other. Several can only be gathered, with at most four lights, and must all
  /// fit on the device as a whole. Their order does not change the image.
  Renderer(const Device& device, std::vector<SceneVolume> volumes, const TableSettings& table, const Progress& progress = {});
  Renderer(const Device&, Volume&&, const Classification&, const TableSettings&, const Progress& = {}) = delete;
  ~Renderer();

  /// Goes on with another transfer function for the next frames, which are the same to the bit as those of a new renderer. What does not
  /// depend on the function is kept: scalars, their gradients and their quads, unless the function's range is another one that gives
  /// scalars other codes (TransferTable). Only for a single volume that is on the device as a whole and is classified after interpolation,
  /// before and after. Otherwise returns false, and nothing changes.
  bool reclassify(const Classification& classification);

  /// Draws a frame and waits for it. `progress` is called about every 50 ms, and may abandon the frame by an exception, which
  /// is passed on; the next frame makes again what was not complete.
  Image render(const Camera& camera, const FrameSettings& settings, const Progress& progress = {});
  /// The same frame, which stays on the device, complete, in layout GENERAL. The renderer draws into these targets again
  /// when nobody else holds them.
  std::shared_ptr<const FrameTargets> renderOnDevice(const Camera& camera, const FrameSettings& settings, const Progress& progress = {});

  /// The sums of the shares of a part in fixed point: those of all parts add up to the same bits, however many parts there are, on
  /// devices of one kind that all draw the whole volume, or all cube by cube. resolveSums makes the image. Drawn as render() would, by
  /// gathering or by splats, the latter with nothing left out as hidden. `settings` must not be sorted. Lack of memory is an
  /// error here where it would make render() draw cubes, as other processes could not know.
  FixedSums renderShares(const Camera& camera, const FrameSettings& settings, const SharePart& part, const Progress& progress = {});

  /// Whether the gather takes so much less than the device's memory that frames will be drawn of the whole volume, and not cube by cube.
  /// True where only the whole volume can be drawn.
  bool surelyFits(const FrameSettings& settings) const;
  /// From now on all gathered frames are drawn cube by cube.
  void requireCubes();
  /// Whether the last frame was drawn cube by cube.
  bool drewInCubes() const { return drewInCubes_; }
  /// How many cubes that frame read, by level of detail.
  std::vector<std::size_t> cubesRead() const;

  /// Memory of the volume, including the table even if no frame has read it; or of a cube.
  VolumeMemory memory() const;
  /// Stage times of what is kept for all frames, and of the last frame, in order.
  std::vector<StageTime> timings() const;
  /// Stage times of what is kept for all frames; empty where frames are drawn cube by cube.
  std::vector<StageTime> buildTimings() const;
  /// Stage times of the last frame, including what was made for it and then kept.
  std::vector<StageTime> frameTimings() const;
  /// The number of occupied voxels. Unknown until a frame needs the blocks of these.
  std::optional<std::uint64_t> occupiedVoxelCount() const;
  /// How the scattered light of the last frame that was lit was found; nothing without such light.
  std::optional<ScatteringFacts> scattering() const;
  /// The counts of the last frame's cut; none without one.
  CutCounts cutCounts() const;

 private:
  friend class RendererStages;  // renderer_stages.h
  struct State;
  State& whole(const Progress& progress);
  CubeDrawing& cubes();
  template <typename DrawWhole, typename DrawCubes>
  auto draw(const Camera& camera, const FrameSettings& settings, bool mayChange, const Progress& progress, const DrawWhole& drawWhole,
            const DrawCubes& drawCubes);
  void check(const Camera& camera, const FrameSettings& settings) const;
  Error withNeed(const Error& error, const FrameSettings& settings, const std::string& whyNotCubes) const;

  const Device& device_;
  const std::shared_ptr<const VolumeSource> source_;
  Classification classification_;
  const TableSettings table_;
  std::shared_ptr<const Volume> volume_;  ///< the whole volume on the host, as long as frames are drawn of it; longer than `state_`
  std::unique_ptr<State> state_;          ///< and on the device; null where it does not fit
  std::unique_ptr<CubeDrawing> cubes_;
  std::unique_ptr<MergedDrawing> merged_;               ///< of several volumes, in place of all of the above
  bool isTooLarge_ = false;                             ///< whether the whole volume certainly does not fit
  bool inCubes_ = false;                                ///< whether gathered frames are drawn cube by cube
  bool drewInCubes_ = false;                            ///< whether the last frame was
  bool builtInFrame_ = false;                           ///< whether the last frame has made what is kept
};

}  // namespace freevoxels
