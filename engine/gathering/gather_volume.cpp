#include "engine/gathering/gather_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "embedded/brick_quads.h"
#include "embedded/shade_blocks_lit.h"
#include "embedded/shade_blocks_unlit.h"
#include "engine/core/error.h"
#include "engine/lighting/light_pass.h"
#include "engine/octree/occupancy.h"
#include "engine/volume/packed_light.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

namespace {

/// The radiance of a stored source term that equals the stored extinction: 1, or more if half floats could not hold the brightest voxel.
/// Lights are as bright as at the least distance that counts. With emission it is a multiple by a power of two of the unit in which
/// voxels have their emission, which is then packed again without an error.
double sourceUnit(const DeviceVolume& volume, const Lighting* lighting) {
  const double emission = volume.emissionUnit * kStoredDepth * volume.voxelSize;
  double brightest = emission;
  if (lighting != nullptr) {
    for (const Light& light : lighting->lights) {
      const double nearest = light.atInfinity ? 1.0 : double(shader::kNearestLight2) * volume.voxelSize * volume.voxelSize;
      const double color = std::max({light.color.r, light.color.g, light.color.b});
      brightest += light.intensity * color / (4.0 * std::numbers::pi * nearest) * kStoredDepth / kBrightest;
    }
  }
  const double least = std::max(brightest, 1.0);
  return emission > 0.0 ? std::ldexp(emission, int(std::ceil(std::log2(least / emission)))) : least;
}

bool dependsOnView(const Lighting& lighting) {
  return lighting.phaseG != 0.0 || lighting.surface > 0.0;
}

/// The factor from extinctions to stored ones.
float extinctionScale(const DeviceVolume& volume) {
  return float(kStoredDepth * volume.voxelSize);
}

/// World length of a voxel's layer along its major axis, averaged over all directions: about 1.2 voxel edges.
float meanLayer(const DeviceVolume& volume) {
  return float(1.2 * volume.voxelSize);
}

}  // namespace

GatherVolume::GatherVolume(const Device& device, const Classification& classification, const BuiltVolume& built, const Cells& met,
                           std::vector<StageTime>& times, const SurroundingLight* surroundings)
    : device_(device),
      classification_(classification),
      built_(built),
      surroundings_(surroundings),
      frame_(device, sizeof(shader::SetupFrame), MemoryUse::Device, "shading frame"),
      bricks_(device, built.volume.hierarchy, hasScalars()) {
  include(met, times);
}

void GatherVolume::makeSources() {
  const std::uint64_t blocks = built_.volume.storedBlocks() + 1;  // so that no buffer is empty
  if (shadesLevel(0) || wantedLevels_ != 1u) {
    if (sources_.bytes() == 0)
      sources_ = Buffer(device_, blocks * sizeof(glm::uvec2), MemoryUse::Device, "source terms");
  }
  if ((hasTowards() || hasEmissionApart()) && extras_.bytes() == 0)
    extras_ = Buffer(device_, blocks * sizeof(std::uint32_t), MemoryUse::Device, "source directions or emission");
}

void GatherVolume::shade(Commands& commands, const Shading& shading, int level) {
  const DeviceVolume& volume = built_.volume;
  const auto count = std::uint32_t(volume.stored[std::size_t(level)]);
  if (count == 0) return;
  const Buffer& anyBuffer = frame_;
  const bool lightOnly = level == 0 && hasScalars();
  const std::array<Binding, 4> bindings{&frame_, shading.table != nullptr ? &shading.table->planeAddresses : &anyBuffer, &volume.occupancy,
                                        shading.lights != nullptr ? &shading.lights->lights() : &anyBuffer};
  const shader::ShadePush push{.blocks = addressWords(built_.lists.of(level, built_.visible).indices.address()),
                               .sources = addressWords(sources_.address()),
                               .extra = addressWords(extras_.address()),
                               .firstRank = volume.firstRank(level),
                               .count = count,
                               .extinctionScale = extinctionScale(volume),
                               .sourceScale = float((lightOnly ? 1.0 : kStoredDepth * volume.voxelSize) / sourceUnit_),
                               .meanLayer = meanLayer(volume),
                               .lightOnly = lightOnly ? 1 : 0,
                               .emissionApart = hasEmissionApart() ? 1 : 0};
  commands.dispatchLinear(shadePass_, bindings, push, count);
  commands.barrier(kComputeStage, kComputeStage);
}

bool GatherVolume::hasColors() const {
  const bool onlyScalars = hasScalars() && wantedLevels_ == 1u;  // whose colours come from the transfer function
  return lit_ || (built_.volume.hasColors && !onlyScalars) || (built_.volume.hasEmission() && !hasEmissionApart());
}

bool GatherVolume::shadesLevel(int level) const {
  return lit_ || level > 0 || (!hasScalars() && (hasColors() || hasEmissionApart()));
}

bool GatherVolume::hasScalars() const {
  return built_.volume.scalarBricks.has_value();
}

const TexelView& GatherVolume::transferTable() const {
  return hasScalars() ? built_.volume.scalarBricks->tableTexels : built_.volume.extinctionQuads;
}

void GatherVolume::prepare(const Shading& shading) {
  if (built_.volume.lacksScalarBricks)
    fail(ErrorKind::OutOfMemory,
         "the volume's scalars take more memory than there is, which classification after interpolation needs: "
         "{} does without",
         Parameter("classification", "pre"));
  const bool samples = lightsSamples(shading.lighting);
  const bool lit = shading.lighting != nullptr && !samples;
  const bool viewDependent = lit && dependsOnView(*shading.lighting);
  const bool emissionWasApart = hasEmissionApart();
  const std::uint64_t version = shading.scattered != nullptr ? shading.scattered->version() : 0;
  const std::uint64_t lightsVersion = lit && shading.lights != nullptr ? shading.lights->version() : 0;
  const bool sameLight = !lit || (lighting_ == *shading.lighting && version == scatteredVersion_ && lightsVersion == sourceLightsVersion_);
  const bool sameSources = lit == lit_ && !viewDependent && !viewDependent_ && sameLight;
  sourceUnit_ = sourceUnit(built_.volume, lit ? shading.lighting : nullptr);
  lit_ = lit;
  viewDependent_ = viewDependent;
  scattered_ = shading.scattered;
  scatteredVersion_ = version;
  sourceLightsVersion_ = lightsVersion;
  deltaScale_ = shading.frame.setup.lighting.deltaScale;
  if (shading.lighting != nullptr)
    lighting_ = *shading.lighting;
  else
    lighting_.reset();
  prepareSampled(samples ? &shading : nullptr);
  wantedLevels_ = 0;
  for (int level = shading.frame.detail.finest; level <= shading.frame.detail.coarsest; ++level)
    wantedLevels_ |= 1u << level;
  if (!sameSources || hasEmissionApart() != emissionWasApart) {
    shadedLevels_ = 0;
    for (Quads& quads : quads_) quads.made = {};
  }
  makeSources();
  const auto makeRoomForAll = [&] {
    for (std::size_t axis = 0; axis < quads_.size(); ++axis)
      if (shading.axes[axis]) makeRoom(quads_[axis], shading.axes);
  };
  try {
    makeRoomForAll();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::OutOfMemory) throw;
    dropOtherAxes(shading.axes, 0);
    makeRoomForAll();
  }
  dropOtherAxes(shading.axes, shading.keptQuadBytes);
}

void GatherVolume::record(Commands& commands, const Shading& shading) {
  if ((wantedLevels_ & ~shadedLevels_) != 0) recordShading(commands, shading);
  if (sampleLights() > 0) recordLightCodes(commands, shading);
  if (hasSurfaces()) recordGradients(commands);
  for (int axis = 0; axis < 3; ++axis) {
    if (!shading.axes[std::size_t(axis)]) continue;
    recordQuads(commands, axis);
    if (sampleLights() > 0) recordLightQuads(commands, axis);
  }
}

GatherVolume::State GatherVolume::state() const {
  State state{.shadedLevels = shadedLevels_, .light = lightMade_, .gradients = gradientsMade_, .quads = {}, .lightQuads = {}};
  for (std::size_t axis = 0; axis < quads_.size(); ++axis) {
    state.quads[axis] = quads_[axis].made;
    state.lightQuads[axis] = quads_[axis].lightMade;
  }
  return state;
}

void GatherVolume::restore(const State& before) {
  shadedLevels_ = before.shadedLevels;
  lightMade_ = before.light;
  gradientsMade_ = before.gradients;
  for (std::size_t axis = 0; axis < quads_.size(); ++axis) {
    quads_[axis].made = before.quads[axis];
    quads_[axis].lightMade = before.lightQuads[axis];
  }
}

std::optional<shader::CodeBricks> GatherVolume::scalarCodes(int level) const {
  if (!hasScalars() || level != 0) return {};
  return built_.volume.scalarBricks->onDevice();
}

void GatherVolume::recordQuads(Commands& commands, int axis) {
  Quads& quads = quads_[std::size_t(axis)];
  if (!bricks_.lack(quads.made, wantedLevels_)) return;
  commands.beginPass("brick quads");
  if (quads.made.levels == 0) recordBricks(commands, axis, kEmptyBrick, scalarCodes(0), quads.medium, hasColors());
  bricks_.forEachMissing(quads.made, wantedLevels_, [&](const GatherBricks::Range& range) {
    const std::optional<shader::CodeBricks> codes = scalarCodes(range.level);
    recordBricks(commands, axis, range, codes, quads.medium, hasColors() && (lit_ || !codes));
  });
  commands.barrier(kComputeStage, kComputeStage);
}

/// Records the quads of bricks, piece by piece.
void GatherVolume::recordBricks(Commands& commands, int axis, const GatherBricks::Range& range,
                                const std::optional<shader::CodeBricks>& codes, const QuadStore& medium, bool colored) {
  const DeviceVolume& volume = built_.volume;
  const Quads& quads = quads_[std::size_t(axis)];
  const bool extra = (hasTowards() && colored) || (hasEmissionApart() && !codes);
  const bool isShaded = codes.has_value() || shadesLevel(range.level);
  const Pipeline pass =
      makeComputePipeline(device_, shaders::brick_quads, {std::uint32_t(axis), extra, colored, codes.has_value(), isShaded});
  const std::array<Binding, 2> bindings{&bricks_.placeTexels(), &volume.occupancyTexels};
  for (std::uint32_t next = range.first; next < range.end;) {
    const std::uint32_t piece = next / bricksPerPiece_;
    const std::uint32_t bricks = std::min(range.end, (piece + 1) * bricksPerPiece_) - next;
    const shader::BrickQuadsPush push{.level = volume.onDevice(range.level),
                                      .firstBrick = next,
                                      .count = bricks,
                                      .firstQuad = next % bricksPerPiece_ * shader::kGatherBrickBlocks,
                                      .medium = addressWords(medium.address(piece)),
                                      .source = addressWords(quads.source.address(piece)),
                                      .extra = addressWords(quads.extra.address(piece)),
                                      .sources = addressWords(isShaded ? sources_.address() : volume.extinction.address()),
                                      .extras = addressWords(extras_.address()),
                                      .extinctionScale = extinctionScale(volume),
                                      .codes = codes.value_or(shader::CodeBricks())};
    commands.dispatchLinear(pass, bindings, push, std::uint64_t(bricks) * shader::kBrickQuadsThreads);
    next += bricks;
  }
}

void GatherVolume::recordShading(Commands& commands, const Shading& shading) {
  const DeviceVolume& volume = built_.volume;
  shadePass_ = makeComputePipeline(device_, lit_ ? shaders::shade_blocks_lit : shaders::shade_blocks_unlit,
                                   {volume.hasEmission(), volume.hasColors, shading.frame.tinted, hasTowards()});
  commands.beginPass("shade blocks");
  commands.update(frame_, shading.frame.setup);
  for (int level = 0; level <= volume.hierarchy.top(); ++level)
    if (((wantedLevels_ & ~shadedLevels_) >> level & 1u) != 0 && shadesLevel(level)) shade(commands, shading, level);
  shadedLevels_ |= wantedLevels_;
}

void GatherVolume::describe(shader::GatherFrame& frame) const {
  for (std::size_t axis = 0; axis < quads_.size(); ++axis) {
    const Quads& quads = quads_[axis];
    const auto setPieces = [](const QuadStore& store, glm::uvec2* addresses) {
      for (std::size_t i = 0; i < store.pieces.size(); ++i) addresses[i] = addressWords(store.pieces[i].address());
    };
    setPieces(quads.medium, frame.axes[axis].mediumPieces);
    setPieces(quads.source, frame.axes[axis].sourcePieces);
    setPieces(quads.extra, frame.axes[axis].extraPieces);
    for (std::size_t i = 0; i < quads.light.size(); ++i) setPieces(quads.light[i], frame.axes[axis].lightPieces[i]);
  }
  frame.extinctionUnit = float(1.0 / (kStoredDepth * built_.volume.voxelSize));
  frame.sourceUnit = float(sourceUnit_);
  frame.color = built_.volume.albedo / float(sourceUnit_);
  frame.projectionLayer = hasScalars() ? frame.extinctionUnit * float(classification_.transferFunction->unitDistance) : 0.0f;
  frame.deltaScale = deltaScale_;
  describeLights(frame);
  for (int number = frame.finest; number <= frame.coarsest; ++number) frame.levels[number] = bricks_.levels()[std::size_t(number)];
}

/// By rank: what shade_blocks.comp stores; of levels that are not shaded extinctions alone, rounded to halves by the host as
/// brick_quads.comp rounds them where the device rounds to nearest.
std::vector<glm::uvec2> GatherVolume::downloadSources(int level, std::size_t count) const {
  const DeviceVolume& volume = built_.volume;
  std::vector<glm::uvec2> stored(count);
  if (stored.empty()) return stored;
  if (shadesLevel(level)) {
    download(device_, sources_, std::as_writable_bytes(std::span(stored)), volume.firstRank(level) * sizeof(glm::uvec2));
    return stored;
  }
  std::vector<float> extinctions(count);
  download(device_, volume.extinction, std::as_writable_bytes(std::span(extinctions)), volume.firstRank(level) * sizeof(float));
  std::ranges::transform(extinctions, stored.begin(), [&](float extinction) {
    const float scaled = std::min(extinctionScale(volume) * extinction, shader::kMaxStored);
    return glm::uvec2(0, glm::packHalf2x16(glm::vec2(scaled, 0.0f)));
  });
  return stored;
}

std::vector<GatherBlocks> GatherVolume::downloadBlocks() const {
  const DeviceVolume& volume = built_.volume;
  std::vector<GatherBlocks> levels(std::size_t(volume.hierarchy.top()) + 1);
  for (int level = 0; level <= volume.hierarchy.top(); ++level) {
    if ((wantedLevels_ >> level & 1u) == 0 || (level == 0 && hasScalars())) continue;
    const GridLayout& grid = volume.hierarchy.levels[std::size_t(level)];
    const std::vector<std::uint32_t> indices = downloadStored(device_, volume, level);
    std::vector<glm::uvec2> stored = downloadSources(level, indices.size());
    std::vector<std::uint32_t> emission(hasEmissionApart() ? indices.size() : 0);
    if (!emission.empty())
      download(device_, extras_, std::as_writable_bytes(std::span(emission)), volume.firstRank(level) * sizeof(std::uint32_t));
    const double perWorldUnit = 1.0 / (kStoredDepth * volume.voxelSize);
    GatherBlocks& blocks = levels[std::size_t(level)];
    blocks.dimensions = grid.dimensions;
    for (const glm::uvec2 block : scatterToDense(stored, indices, grid.voxels())) {
      blocks.extinction.push_back(perWorldUnit * double(glm::unpackHalf2x16(block.y).x));
      blocks.source.push_back(hasColors() ? sourceUnit_ * perWorldUnit * unpackColor(block.x)
                                          : blocks.extinction.back() * glm::dvec3(volume.albedo));
    }
    if (hasEmissionApart())
      for (const std::uint32_t packed : scatterToDense(emission, indices, grid.voxels()))
        blocks.emission.push_back(sourceUnit_ * perWorldUnit * unpackColor(packed));
  }
  return levels;
}

}  // namespace freevoxels
