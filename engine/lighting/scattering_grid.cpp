#include "engine/lighting/scattering_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "embedded/scattering_collect.h"
#include "embedded/scattering_combine.h"
#include "embedded/scattering_direct.h"
#include "embedded/scattering_dots.h"
#include "embedded/scattering_refine.h"
#include "embedded/scattering_source.h"
#include "embedded/scattering_sweep.h"
#include "embedded/scattering_texels.h"
#include "engine/attenuation/ray_sweep.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr int kDirections = 26;

/// A light in the index space of direct cells.
RaySource directSource(const Light& light, const glm::dmat4& indexToWorld, const CellGrid& direct) {
  const RaySource source = lightSource(light, indexToWorld);
  if (!light.atInfinity) return {.place = (source.place + 0.5) / double(direct.edge) - 0.5};
  const glm::dvec3 size = glm::abs(source.place);
  return {.place = source.place / std::max({size.x, size.y, size.z}), .atInfinity = true};
}

bool isGreyLight(const Lighting& lighting) {
  const auto grey = [](const glm::dvec3& color) { return color.r == color.g && color.g == color.b; };
  return !lighting.environment && grey(lighting.ambient) && grey(lighting.tint) &&
         std::ranges::all_of(lighting.lights, [&](const Light& light) { return grey(light.color); });
}

Buffer makeBuffer(const Device& device, std::size_t values, const char* name, MemoryUse use = MemoryUse::Device,
                  VkBufferUsageFlags usage = 0) {
  return Buffer(device, std::max<std::size_t>(values, 1) * sizeof(float), use, name, usage);
}

/// Floats that shaders write as a buffer and read as texels.
std::pair<Buffer, TexelView> makeFloats(const Device& device, std::size_t values, const char* name) {
  Buffer buffer = makeBuffer(device, values, name, MemoryUse::Device, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  TexelView view(device, buffer, VK_FORMAT_R32_SFLOAT);
  return {std::move(buffer), std::move(view)};
}

/// How many directions are swept at once, whose light has so many values each. It takes at most a small part of the device's memory, and
/// is swept at once where there is much.
int batchOf(const Device& device, std::uint64_t values) {
  constexpr std::uint64_t kPartOfMemory = 16;
  return int(std::clamp<std::uint64_t>(device.memoryBytes() / kPartOfMemory / (values * sizeof(float)), 1, kDirections));
}

}  // namespace

std::uint64_t ScatteringGrid::bytes(const Device& device, glm::ivec3 dimensions, const glm::dmat4& indexToWorld, const Lighting& lighting) {
  constexpr std::uint64_t kChannels = 3;
  const std::size_t cells = ScatteringMedium::gridOf(dimensions).count();
  const std::uint64_t planes = kChannels * (lighting.phaseG != 0.0 ? 4 : 1), medium = 3 * kChannels;
  // 1 + 1/8 + 1/64 + ... = 8/7: with all coarser grids.
  const std::uint64_t swept = kChannels * std::uint64_t(batchOf(device, kChannels * cells));
  const std::uint64_t solving = cells * sizeof(float) * (planes * (shader::kMaxBasis + 3) + medium + swept) * 8 / 7;
  const CellGrid direct = ScatteringMedium::directGridOf(dimensions);
  std::uint64_t rays = 0;
  for (const Light& light : lighting.lights) rays = std::max(rays, denseRayBytes(direct.cells, directSource(light, indexToWorld, direct)));
  const glm::u64vec3 padded(direct.cells + 2);
  return std::max(solving, rays + sizeof(float) * (padded.x * padded.y * padded.z + cells * (planes + medium)));
}

ScatteringGrid::ScatteringGrid(const Device& device, const ScatteringMedium& medium, const Lighting& lighting)
    : device_(device), medium_(medium), directions_(sphereQuadrature(medium.indexToWorld())), count_(medium.grid().count()) {
  const PhaseSplit split = splitPhase(lighting);
  channels_ = medium.isGrey() && isGreyLight(lighting) ? 1 : 3;
  moments_ = split.g != 0.0 ? 4 : 1;
  flux_ = 3.0 * split.g;
  tinted_ = channels_ == 3 && (split.forward > 0.0 || lighting.isTinted());
  hasSky_ = lighting.hasAmbient();
  emits_ = medium.emits();
  lit_ = !lighting.lights.empty() && lighting.scattering != 1;  // what is scattered once is not in cells
  depthScale_ = lighting.tint * deltaScaleOf(lighting, medium);
  compileAhead();

  std::vector<float> planes;
  const auto addPlane = [&](auto&& value) {
    for (const ScatteringMedium::Cell& cell : medium.cells()) planes.push_back(float(value(cell)));
  };
  const std::vector<double> surfaces = lighting.surface > 0.0 ? medium.surfaceShares() : std::vector<double>(count_, 0.0);
  for (int c = 0; c < (tinted_ ? channels_ : 1); ++c)
    addPlane([&](const auto& cell) { return lighting.tint[c] * (cell.extinction - split.forward * cell.scattering[c]); });
  for (int c = 0; c < channels_; ++c)
    for (std::size_t i = 0; i < count_; ++i)
      planes.push_back(
          float(lighting.tint[c] * (1.0 - split.forward) * (1.0 - lighting.surface * surfaces[i]) * medium.cells()[i].scattering[c]));
  for (int c = 0; c < channels_ && emits_; ++c) addPlane([&](const auto& cell) { return cell.emission[c]; });
  std::tie(mediumPlanes_, mediumTexels_) = makeFloats(device, planes.size(), "scattering medium");
  upload(device, mediumPlanes_, std::as_bytes(std::span(planes)));

  const std::vector<glm::dvec3> sky = surroundingRadiances(lighting, directions_, medium.indexToWorld());
  std::vector<shader::SweepDirection> sweepDirections;
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const QuadratureDirection& direction = directions_[i];
    sweepDirections.push_back({.step = direction.step,
                               .stepLength = float(medium.grid().edge * direction.length),
                               .unit = direction.unit,
                               .weight = float(direction.weight),
                               .sky = sky[i]});
  }
  sweepDirections_ = Buffer(device, std::span(sweepDirections).size_bytes(), MemoryUse::Device, "scattering directions");
  upload(device, sweepDirections_, std::as_bytes(std::span(sweepDirections)));

  const auto vectorSize = std::size_t(vectorLength());
  std::tie(direct_, directTexels_) = makeFloats(device, vectorSize, "direct light of cells");
  if (lit_) makeDirect(lighting);  // with buffers of its own, before there are more
  std::tie(vectors_, vectorTexels_) = makeFloats(device, (kBasis + shader::kMaxBasis + 1) * vectorSize, "scattering vectors");
  sources_ = Buffer(device, std::size_t(moments_) * count_ * sizeof(glm::vec4), MemoryUse::Device, "scattering sources",
                    VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
  sourceTexels_ = TexelView(device, sources_);
  const std::size_t values = std::size_t(channels_) * count_;
  batch_ = batchOf(device, values);
  std::tie(light_, lightTexels_) = makeFloats(device, std::size_t(batch_) * values, "light of directions");
  sums_ = makeBuffer(device, std::size_t(shader::kMaxBasis + 2) * std::size_t(shader::kDotSums), "scattering sums", MemoryUse::Readback);
  Commands commands(device);
  commands.beginPass("scattering");
  commands.clear(vectors_);
  commands.submitAndWait();
}

/// Asks for all pipelines at once, so that they are compiled at the same time.
void ScatteringGrid::compileAhead() const {
  if (lit_) makeComputePipeline(device_, shaders::scattering_direct, directConstants(true, true));
  makeComputePipeline(device_, shaders::scattering_source, constants());
  makeComputePipeline(device_, shaders::scattering_sweep, sweepConstants());
  makeComputePipeline(device_, shaders::scattering_collect, constants());
  for (const Shader* shader :
       {&shaders::scattering_dots, &shaders::scattering_combine, &shaders::scattering_refine, &shaders::scattering_texels})
    makeComputePipeline(device_, *shader);
}

/// The extinctions of direct cells with a border of empty ones.
Buffer ScatteringGrid::uploadDirectExtinctions() const {
  const glm::ivec3 cells = medium_.directGrid().cells, size = cells + 2;
  const std::vector<float> extinctions = medium_.directExtinction();
  std::vector<float> padded(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z), 0.0f);
  for (int z = 0; z < cells.z; ++z)
    for (int y = 0; y < cells.y; ++y)
      std::copy_n(&extinctions[medium_.directGrid().index({0, y, z})], cells.x,
                  &padded[1 + std::size_t(size.x) * (std::size_t(y) + 1 + std::size_t(size.y) * (std::size_t(z) + 1))]);
  Buffer buffer(device_, std::span(padded).size_bytes(), MemoryUse::Device, "extinctions of cells",
                VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  upload(device_, buffer, std::as_bytes(std::span(padded)));
  return buffer;
}

void ScatteringGrid::makeDirect(const Lighting& lighting) {
  const CellGrid& fine = medium_.directGrid();
  const Buffer extinction = uploadDirectExtinctions();
  const TexelView texels(device_, extinction, VK_FORMAT_R32_SFLOAT);
  const TexelView noTexels(device_, extinction, VK_FORMAT_R32_UINT, sizeof(std::uint32_t));
  const Buffer fans(device_, sizeof(shader::DirectFans), MemoryUse::Device, "rays through cells");
  const glm::dmat3 directToWorld = glm::dmat3(medium_.indexToWorld()) * double(fine.edge);
  RaySweep rays(device_, "scattering");
  for (std::size_t i = 0; i < lighting.lights.size(); ++i) {
    const Light& light = lighting.lights[i];
    const RaySource source = directSource(light, medium_.indexToWorld(), fine);
    Commands commands(device_);
    rays.record(commands, {.dimensions = fine.cells, .indexToWorld = directToWorld, .texels = texels}, source);
    shader::DirectFans onDevice{};
    std::ranges::copy(rays.fans(), onDevice.fans);
    commands.update(fans, onDevice);
    const std::optional<TexelView>& depths = rays.depthTexels();
    const std::array<Binding, 4> bindings{&texels, &direct_, &fans, depths ? &*depths : &noTexels};
    const shader::ScatteringDirectPush push{.cells = medium_.grid().cells,
                                            .directCells = fine.cells,
                                            .ratio = medium_.grid().edge / fine.edge,
                                            .place = source.place,
                                            .radiance = light.intensity / (4.0 * std::numbers::pi) * light.color,
                                            .depthScale = depthScale_,
                                            .isFirst = i == 0 ? 1 : 0,
                                            .directToWorld = directToWorld,
                                            .rays = addressWords(rays.depths().address())};
    commands.dispatchLinear(makeComputePipeline(device_, shaders::scattering_direct, directConstants(depths.has_value(), light.atInfinity)),
                            bindings, push, count_);
    commands.submitAndWait();
  }
}

void ScatteringGrid::startFrom(const ScatteringGrid& coarse) {
  FV_CHECK_EQ(coarse.planes(), planes());
  Commands commands(device_);
  commands.beginPass("scattering");
  const std::array<Binding, 2> bindings{&coarse.vectorTexels_, &vectors_};
  commands.dispatchLinear(
      makeComputePipeline(device_, shaders::scattering_refine), bindings,
      shader::ScatteringRefinePush{.cells = medium_.grid().cells, .coarseCells = coarse.medium_.grid().cells, .planes = planes()}, count_);
  commands.submitAndWait();
}

void ScatteringGrid::sweep(const Sweep& wanted, const Progress& progress) {
  Commands commands(device_);
  commands.beginPass("scattering");
  const int scattering = tinted_ ? channels_ : 1;
  const shader::ScatteringSourcePush sources{.count = int(count_),
                                             .scattering = scattering,
                                             .emission = wanted.emission && emits_ ? scattering + channels_ : -1,
                                             .from = wanted.scattered,
                                             .direct = wanted.direct && lit_ ? 0 : -1};
  const std::array<Binding, 4> sourceBindings{&mediumTexels_, &vectorTexels_, &directTexels_, &sourceTexels_};
  commands.dispatchLinear(makeComputePipeline(device_, shaders::scattering_source, constants()), sourceBindings, sources, count_);
  commands.barrier(kComputeStage, kComputeStage);
  const Pipeline sweepPass = makeComputePipeline(device_, shaders::scattering_sweep, sweepConstants());
  const Pipeline collectPass = makeComputePipeline(device_, shaders::scattering_collect, constants());
  const std::array<Binding, 4> sweepBindings{&mediumTexels_, &sourceTexels_, &sweepDirections_, &light_};
  const std::array<Binding, 4> collectBindings{&sweepDirections_, &lightTexels_, &vectorTexels_, &vectors_};
  const glm::ivec3 cells = medium_.grid().cells;
  const std::uint64_t lines = std::max({std::uint64_t(cells.x) * std::uint64_t(cells.y), std::uint64_t(cells.x) * std::uint64_t(cells.z),
                                        std::uint64_t(cells.y) * std::uint64_t(cells.z)});
  for (int first = 0; first < kDirections; first += batch_) {
    const int directions = std::min(batch_, kDirections - first);
    if (first > 0) commands.barrier(kComputeStage, kComputeStage);
    commands.dispatchLinear(
        sweepPass, sweepBindings,
        shader::ScatteringSweepPush{.cells = cells, .firstDirection = first, .hasSky = wanted.sky && hasSky_ ? 1 : 0, .flux = float(flux_)},
        lines, std::uint32_t(directions));
    commands.barrier(kComputeStage, kComputeStage);
    commands.dispatchLinear(collectPass, collectBindings,
                            shader::ScatteringCollectPush{.count = int(count_),
                                                          .firstDirection = first,
                                                          .directions = directions,
                                                          .isLast = first + directions == kDirections ? 1 : 0,
                                                          .from = wanted.from,
                                                          .to = wanted.to,
                                                          .ofFrom = wanted.ofFrom,
                                                          .ofSum = wanted.ofSum},
                            count_);
  }
  commands.submitAndWait(progress);
}

void ScatteringGrid::sweepResidual(int to, const Progress& progress) {
  sweep(
      {.scattered = kSolution, .direct = true, .emission = true, .sky = true, .from = kSolution, .to = to, .ofFrom = -1.0f, .ofSum = 1.0f},
      progress);
}

void ScatteringGrid::sweepDifference(int from, int to, const Progress& progress) {
  sweep({.scattered = from, .direct = false, .emission = false, .sky = false, .from = from, .to = to, .ofFrom = 1.0f, .ofSum = -1.0f},
        progress);
}

int ScatteringGrid::sweepOrders(int orders, const Progress& progress) {
  int sets = 0;
  for (int order = 1; order <= orders; ++order) {
    // What reaches the medium unscattered is scattered once where it is seen.
    if (order == 1 && !hasSky_ && !emits_) continue;
    sweep({.scattered = order == 1 ? -1 : kSolution,
           .direct = order > 1,
           .emission = true,
           .sky = true,
           .from = kSolution,
           .to = kBasis,
           .ofFrom = 0.0f,
           .ofSum = 1.0f},
          progress);
    combine({.to = kSolution, .from = kBasis});
    ++sets;
  }
  return sets;
}

std::vector<double> ScatteringGrid::dots(int vector, int first, int count) {
  FV_CHECK_LE(count, shader::kMaxBasis + 2);
  Commands commands(device_);
  commands.beginPass("scattering");
  const std::array<Binding, 2> bindings{&vectorTexels_, &sums_};
  commands.dispatch(makeComputePipeline(device_, shaders::scattering_dots), bindings,
                    shader::ScatteringDotsPush{.values = vectorLength(), .vector = vector, .first = first, .count = count},
                    {shader::kDotSums, 1, 1});
  commands.submitAndWait();
  const auto* const parts = reinterpret_cast<const float*>(sums_.mapped());
  std::vector<double> result(std::size_t(count), 0.0);
  for (std::size_t product = 0; product < result.size(); ++product)
    for (std::size_t sum = 0; sum < std::size_t(shader::kDotSums); ++sum)
      result[product] += double(parts[product * std::size_t(shader::kDotSums) + sum]);
  return result;
}

void ScatteringGrid::combine(const Combination& combination) {
  FV_CHECK_LE(combination.factors.size(), std::size_t(shader::kMaxBasis));
  shader::ScatteringCombinePush push{.values = vectorLength(),
                                     .to = combination.to,
                                     .from = combination.from,
                                     .first = combination.first,
                                     .count = int(combination.factors.size()),
                                     .scale = float(combination.scale),
                                     .factors = {}};
  for (std::size_t i = 0; i < combination.factors.size(); ++i) push.factors[i] = float(combination.factors[i]);
  Commands commands(device_);
  commands.beginPass("scattering");
  const std::array<Binding, 2> bindings{&vectorTexels_, &vectors_};
  commands.dispatchLinear(makeComputePipeline(device_, shaders::scattering_combine), bindings, push, std::uint64_t(vectorLength()));
  commands.submitAndWait();
}

Buffer ScatteringGrid::makeTexels() {
  Buffer texels(device_, count_ * std::size_t(moments_) * sizeof(glm::vec4), MemoryUse::Device, "scattered light",
                VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  Commands commands(device_);
  commands.beginPass("scattering");
  const std::array<Binding, 2> bindings{&vectors_, &texels};
  commands.dispatchLinear(makeComputePipeline(device_, shaders::scattering_texels), bindings,
                          shader::ScatteringTexelsPush{.count = int(count_), .channels = channels_, .moments = moments_}, count_);
  commands.submitAndWait();
  return texels;
}

}  // namespace freevoxels
