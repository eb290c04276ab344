#pragma once
// Whether frames of a baked volume are drawn region by region (engine/region_renderer.h).

#include <memory>

#include "apps/freevoxels/render_options.h"
#include "engine/storage/fvx_file.h"

namespace freevoxels {

/// The baked volume of a scene, where its frames can be drawn region by region; null otherwise, the reason being said with --verbose.
std::shared_ptr<const fvx::FvxFile> drawableByRegions(const RenderOptions& options, const SceneOptions& scene, int frames);

/// Whether they are: always where shares are drawn by splats, so that a process reads its own part of the file alone; otherwise where
/// the device or this machine cannot hold `level`, from which they would be drawn else. The answer is certain only where it is yes.
bool needsRegions(const RenderOptions& options, const Device& device, const fvx::FvxFile& file, int level);

}  // namespace freevoxels
