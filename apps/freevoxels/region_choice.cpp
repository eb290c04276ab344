#include "apps/freevoxels/region_choice.h"

#include "apps/freevoxels/failure.h"
#include "engine/memory_planner.h"
#include "engine/region_renderer.h"
#include "engine/streamed_renderer.h"

namespace freevoxels {

namespace {

/// The least that the gather needs of the device for a level.
std::uint64_t leastBytes(const PieceDrawing& pieces, int level) {
  std::uint64_t bricks = 0;
  for (const fvx::ChunkEntry& chunk : pieces.file->chunks(fvx::Channel::Scalars, level)) bricks += std::uint64_t(chunk.bricks());
  return leastGatherBytes(bricks * fvx::kBrickVoxels, pieces.file->dimensions(level),
                          fvx::levelToWorld(pieces.file->description().volume.indexToWorld, level),
                          pieces.settings.lighting ? &*pieces.settings.lighting : nullptr,
                          pieces.file->description().volume.temperature.has_value());
}

}  // namespace

PieceDrawing pieceDrawing(const RenderOptions& options, const SceneDescription& scene, int frames) {
  PieceDrawing result{.file = scene.input.baked()};
  if (!result.file || options.shares.coloredParts) return result;
  const Scene view = scene.resolve(std::make_shared<const Volume>(bakedOutline(*result.file)));
  std::vector<Camera> cameras{view.camera};
  if (frames > 1) cameras = scene.cameras(*view.volume, view.classification, frames);
  result.settings = options.frameSettings();
  result.settings.lighting = view.lighting;
  if (!options.drawsShares()) {
    const std::optional<std::string> reason = isAsBaked(*view.volume, view.classification)
                                                  ? StreamedRenderer::whyNot(*result.file, result.settings)
                                                  : "another transfer function than the baked one needs all scalars";
    if (!reason) {
      result.way = PieceDrawing::Way::Cubes;
      return result;
    }
    result.whyNotCubes = withOptions(*reason);
  }
  const std::optional<std::string> reason =
      RegionRenderer::whyNot(*result.file, view.classification, scene.method.table(), cameras, result.settings);
  if (reason)
    result.whyNone = result.whyNotCubes.empty() || !drawsByGathering(result.settings) ? withOptions(*reason) : result.whyNotCubes;
  else
    result.way = PieceDrawing::Way::Regions;
  return result;
}

MemoryLimits memoryLimits(const RenderOptions& options, const Device& device) {
  const auto least = [&](std::uint64_t value) { return options.group != nullptr ? options.group->least(value) : value; };
  return {.deviceBytes = least(device.memoryBytes()), .hostBytes = least(machineMemoryBytes() / 2), .voxels = least(maximumVoxels(device))};
}

bool needsPieces(const RenderOptions& options, const MemoryLimits& limits, const PieceDrawing& pieces, int level) {
  if (pieces.way == PieceDrawing::Way::None) return false;
  if (options.drawsShares() && !drawsByGathering(pieces.settings)) return true;
  const fvx::FvxFile& file = *pieces.file;
  std::uint64_t active = 0;
  for (const fvx::ChunkEntry& chunk : file.chunks(fvx::Channel::Scalars, level)) active += chunk.activeVoxels;
  if (exceedsDevice(limits.deviceBytes, limits.voxels, file.dimensions(level), active) || active > limits.hostBytes / sizeof(float)) return true;
  return pieces.way == PieceDrawing::Way::Cubes && leastBytes(pieces, level) > limits.deviceBytes;
}

}  // namespace freevoxels
