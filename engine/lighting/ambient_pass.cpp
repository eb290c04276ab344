#include "engine/lighting/ambient_pass.h"

#include <array>
#include <numeric>
#include <tuple>

#include "embedded/ambient_sweep.h"
#include "engine/volume/cell_extinctions.h"

namespace freevoxels {

namespace {

constexpr DirectionSet kDirections = DirectionSet::Directions26;

std::size_t countOf(glm::ivec3 cells) {
  return std::size_t(cells.x) * std::size_t(cells.y) * std::size_t(cells.z);
}

}  // namespace

int ambientCellEdge(glm::ivec3 dimensions, bool hasPhase) {
  int edge = 1;
  while (countOf((dimensions + edge - 1) / edge) > (hasPhase ? kMaxPhaseCells : kMaxAmbientCells)) edge *= 2;
  return edge;
}

AmbientPass::AmbientPass(const Device& device, const Volume& volume, const Classification& classification, int edge)
    : AmbientPass(device, volume.dimensions, volume.indexToWorld, edge, cellExtinctions(volume, classification, edge)) {}

AmbientPass::AmbientPass(const Device& device, glm::ivec3 dimensions, const glm::dmat4& indexToWorld, int edge,
                         std::span<const float> extinctions)
    : device_(device), indexToWorld_(indexToWorld), edge_(edge), cells_((dimensions + edge_ - 1) / edge_) {
  std::tie(extinction_, extinctionTexels_) = uploadTexels(device, std::as_bytes(extinctions), VK_FORMAT_R32_SFLOAT, "extinctions of cells");
}

int AmbientPass::channelCount(const Lighting& lighting) {
  return lighting.environment || lighting.isTinted() ? 3 : 1;
}

bool AmbientPass::record(Commands& commands, const Lighting& lighting, const RaySource& eye) {
  const int channels = channelCount(lighting);
  const bool hasPhase = lighting.phaseG != 0.0;
  const std::vector<glm::dvec3> light = directionLight(lighting, kDirections, indexToWorld_);
  const std::vector<double> shares = directionShares(kDirections, indexToWorld_);
  double octaves = 0.0;  // sum of the octaves without shadows
  for (int octave = 0; octave < lighting.scattering; ++octave) octaves += lighting.octaveScale(octave);
  unshadowed_ = octaves * std::accumulate(light.begin(), light.end(), glm::dvec3(0.0));
  if (hasPhase)
    for (std::size_t i = 0; i < light.size(); ++i) unshadowed_ = glm::max(unshadowed_, octaves / shares[i] * light[i]);
  std::vector<glm::dvec3> parts;
  for (std::size_t i = 0; i < light.size(); ++i) {
    parts.emplace_back(shares[i] / octaves);
    for (int c = 0; c < 3 && channels > 1; ++c)
      if (unshadowed_[c] > 0.0) parts[i][c] = light[i][c] / unshadowed_[c];
  }
  const Lighting like{.tint = lighting.tint,
                      .phaseG = lighting.phaseG,
                      .scattering = lighting.scattering,
                      .scatteringScale = lighting.scatteringScale};
  if (parts == parts_ && like == like_ && (!hasPhase || eye == eye_)) return false;
  parts_ = std::move(parts);
  like_ = like;
  eye_ = eye;

  const VkDeviceSize bytes = extinction_.bytes() * VkDeviceSize(channels + (hasPhase ? 1 : 0));
  if (light_.bytes() != bytes) {
    light_ = Buffer(device_, bytes, MemoryUse::Device, "ambient light of cells",
                    VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
    lightTexels_ = TexelView(device_, light_, VK_FORMAT_R32_SFLOAT);
  }
  pipeline_ = makeComputePipeline(device_, shaders::ambient_sweep, {std::uint32_t(channels), hasPhase ? 1u : 0u});
  commands.beginPass("ambient sweep");
  commands.clear(light_);
  const std::array<Binding, 2> bindings{&extinctionTexels_, &lightTexels_};
  for (int i = 0; i < directionCount(kDirections); ++i) {
    const glm::ivec3 step = -directionCell(kDirections, i);
    const shader::AmbientSweepPush push{
        .cells = cells_,
        .step = step,
        .stepLength = float(edge_ * glm::length(glm::dmat3(indexToWorld_) * glm::dvec3(step))),
        .share = parts_[std::size_t(i)],
        .weight = float(shares[std::size_t(i)] / octaves),
        .octaves = lighting.scattering,
        .octaveScale = float(lighting.scatteringScale),
        .phaseG = float(lighting.phaseG),
        .cellToWorld = glm::dmat3(indexToWorld_) * double(edge_),
        .eye = eye.atInfinity ? glm::normalize(eye.place) : (eye.place + 0.5) / double(edge_) - 0.5,
        .orthographic = eye.atInfinity ? 1 : 0,
        .tint = lighting.tint};
    const int planes = step.z != 0 ? cells_.z : step.y != 0 ? cells_.y : cells_.x;
    const std::uint64_t lines = std::uint64_t(cells_.x) * std::uint64_t(cells_.y) * std::uint64_t(cells_.z) / std::uint64_t(planes);
    if (i > 0) commands.barrier(kComputeStage, kComputeStage);
    commands.dispatchLinear(pipeline_, bindings, push, lines);
  }
  commands.barrier(kComputeStage, kComputeStage);
  return true;
}

}  // namespace freevoxels
