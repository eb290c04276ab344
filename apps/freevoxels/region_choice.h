#pragma once
// Whether frames of a baked volume are drawn piece by piece: by gathering, cube by cube (engine/streamed_renderer.h), or by splats, region by
// region (engine/region_renderer.h).

#include <memory>
#include <string>

#include "apps/freevoxels/render_options.h"
#include "engine/storage/fvx_file.h"

namespace freevoxels {

/// How frames of a volume can be drawn that is not in memory as a whole.
struct PieceDrawing {
  enum class Way { None, Cubes, Regions };
  Way way = Way::None;
  std::shared_ptr<const fvx::FvxFile> file = nullptr;  ///< null where the volume is no baked one
  FrameSettings settings = {};                         ///< of the frames, with lighting
  std::string whyNotCubes = {}, whyNone = {};          ///< clauses, with the names of options
};
PieceDrawing pieceDrawing(const RenderOptions& options, const SceneDescription& scene, int frames);

/// What a volume has to fit into to be drawn at once, on every process of a group, so that all of them decide alike.
struct MemoryLimits {
  std::uint64_t deviceBytes = 0, hostBytes = 0, voxels = 0;
};
/// All processes of the group must call it.
MemoryLimits memoryLimits(const RenderOptions& options, const Device& device);

/// Whether they are, where they can be: always where shares are drawn by splats, so that a process reads its own part of the file alone;
/// otherwise where a device or a machine cannot hold what is drawn of `level` at once. The answer is certain only where it is yes.
bool needsPieces(const RenderOptions& options, const MemoryLimits& limits, const PieceDrawing& pieces, int level);

}  // namespace freevoxels
