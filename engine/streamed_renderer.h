#pragma once
// Draws a baked volume that need not fit into memory by gathering: Subr et al. 2007, Section 5. Cubes of the volume are read from the file
// one after the other, in the order in which rays meet them, and each ray continues in the next cube with the sums and the transmittance
// that the cubes in front of it left. Positions on rays are those in the whole volume, so that the image is the one that Renderer gathers
// with all voxels in memory, up to rounding, and has the same bits with every memory limit.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/frame_renderer.h"
#include "engine/storage/baked_volume.h"
#include "engine/streamed_level.h"
#include "engine/volume/classification.h"

namespace freevoxels {

class StreamedRenderer : public FrameRenderer {
 public:
  /// Cubes have this number of voxels along an edge, and are read with this number of voxels around them: enough for the light of surfaces,
  /// and whole bricks.
  static constexpr int kCubeEdge = kStreamedCubeEdge, kCubeHalo = 8;

  /// Why frames of a file cannot be drawn cube by cube, as a clause; nothing if they can.
  static std::optional<std::string> whyNot(const fvx::FvxFile& file, const FrameSettings& settings);

  /// `level` of the file takes the place of the volume. Frames must be such that whyNot() has no reason.
  StreamedRenderer(const Device& device, std::shared_ptr<const fvx::FvxFile> file, int level, const Classification& classification,
                   const TableSettings& table);
  ~StreamedRenderer() override;

  /// Light that reaches voxels is kept for further frames. Fails with ErrorKind::OutOfMemory where one cube does not fit.
  Image render(const Camera& camera, const FrameSettings& settings, const Progress& progress = {}) override;

  std::vector<StageTime> timings() const override;
  VolumeMemory memory() const override;
  /// How many cubes the last frame read, by level above the one that takes the place of the volume.
  const std::vector<std::size_t>& cubesRead() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace freevoxels
