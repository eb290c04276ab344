#include "apps/freevoxels/region_choice.h"

#include <spdlog/spdlog.h>

#include "apps/freevoxels/failure.h"
#include "engine/octree/volume_limits.h"
#include "engine/region_renderer.h"

namespace freevoxels {

namespace {

/// The least that a voxel with data takes on the device: its extinction and its place in the lists of what is drawn.
constexpr std::uint64_t kLeastDeviceBytes = 12;

}  // namespace

std::shared_ptr<const fvx::FvxFile> drawableByRegions(const RenderOptions& options, const SceneOptions& scene, int frames) {
  std::shared_ptr<const fvx::FvxFile> file = scene.input.baked();
  if (!file || options.shares.coloredParts) return nullptr;
  const Scene view = scene.resolve(std::make_shared<const Volume>(bakedOutline(*file)));
  std::vector<Camera> cameras{view.camera};
  if (frames > 1) cameras = scene.cameras(*view.volume, view.classification, frames);
  FrameSettings settings = options.frameSettings();
  settings.lighting = view.lighting;
  const std::optional<std::string> reason =
      RegionRenderer::whyNot(*file, view.classification, options.method.table(), cameras, settings);
  if (reason) spdlog::debug("{} cannot be drawn region by region: {}", file->path().string(), withOptions(*reason));
  return reason ? nullptr : file;
}

bool needsRegions(const RenderOptions& options, const Device& device, const fvx::FvxFile& file, int level) {
  if (options.drawsShares() && !options.shares.coloredParts && !drawsByGathering(options.frameSettings())) return true;
  const glm::u64vec3 box(file.dimensions(level));
  if (box.x * box.y * box.z > maximumVoxels(device)) return true;
  std::uint64_t active = 0;
  for (const fvx::ChunkEntry& chunk : file.chunks(fvx::Channel::Scalars, level)) active += chunk.activeVoxels;
  return active > device.memoryBytes() / kLeastDeviceBytes || active > machineMemoryBytes() / 2 / sizeof(float);
}

}  // namespace freevoxels
