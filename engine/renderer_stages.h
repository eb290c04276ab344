#pragma once
// What the stages of a renderer make, copied to the host: for tests, validation, and the viewer's diagnosis. Programs that draw do
// not need it.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/gathering/gather_stages.h"
#include "engine/octree/level_data.h"
#include "engine/renderer.h"
#include "engine/scene/source_rays.h"
#include "engine/splatting/splat_sums.h"

namespace freevoxels {

/// Refers to a renderer, which must outlive it, and which draws the volume as a whole: else fails with ErrorKind::OutOfMemory. Makes what
/// no frame has needed yet. All functions wait for the device.
class RendererStages {
 public:
  explicit RendererStages(const Renderer& renderer);

  /// Extinction per world unit, voxels x fastest without padding.
  std::vector<float> downloadExtinction() const;
  /// Emission of the voxels, in the same order; empty if there is none.
  std::vector<glm::dvec3> downloadEmission() const;
  /// What the last frame that was lit had of light that was scattered before, from the surroundings or emitted; none without such light.
  std::optional<ScatteredField> downloadScattered() const;
  /// The attenuation table: bytes [direction][voxel], voxels x fastest without padding.
  std::vector<std::vector<std::uint8_t>> downloadTable() const;
  /// Depths along rays from a source. Fails with ErrorKind::OutOfMemory.
  RayCodes downloadRays(const RaySource& source) const;
  /// Indices (Volume::at) of the occupied voxels, in the order in which they are drawn.
  std::vector<std::uint32_t> downloadBlockList() const;
  /// The blocks that the last frame drew, in that order, if it was not sorted.
  std::vector<Block> downloadDrawnBlocks() const;
  /// The levels above the voxels; the first has blocks of 2³ voxels.
  std::vector<LevelData> downloadLevels() const;

  /// The sums of every pixel, top row first, which render() resolves. `settings` must be of splats, and not sorted. Sums of the parts of a
  /// volume add up to those of the whole; therefore no hidden blocks are left out.
  std::vector<SplatSums> renderSums(const Camera& camera, const FrameSettings& settings) const;
  /// What Renderer::render makes by gathering, with the stages before the image. `settings` must gather.
  GatherStages renderGatherStages(const Camera& camera, const FrameSettings& settings) const;
  /// The sums that the rays at `places` of the frame's lattice (x + y times its width) have if they are marched in this order and without
  /// the others, whose sums are 0.
  std::vector<GatherSums> marchListed(const Camera& camera, const FrameSettings& settings, std::span<const std::uint32_t> places) const;

 private:
  void clearGather(const Camera& camera, const FrameSettings& settings) const;

  Renderer::State& state_;
};

}  // namespace freevoxels
