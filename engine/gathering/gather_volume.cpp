#include "engine/gathering/gather_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

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
      frame_(device, sizeof(shader::SetupFrame), MemoryUse::Device, "shading frame") {
  makeBricks(met, times);
  const std::uint32_t bricks = firstBricks_.back();
  const std::uint64_t quads = std::uint64_t(bricks) * shader::kGatherBrickBlocks;
  inPieces_ = quads > device.limits().maxTexelBufferElements || quads * sizeof(glm::uvec4) > device.maximumAllocation();
  bricksPerPiece_ = inPieces_ ? 1u << shader::kPieceBricksLog2 : bricks;
  if (bricks > std::uint64_t(bricksPerPiece_) * shader::kMaxPieces)
    fail(ErrorKind::OutOfMemory, "the gather needs {} quads of voxels, more than the {} that it can number: use {}", quads,
         std::uint64_t(bricksPerPiece_) * shader::kMaxPieces * shader::kGatherBrickBlocks, Parameter("draw", "splats"));
}

/// Finds the cells of the octree that are bricks, and those that rays skip. A position in a cell stays for
/// one more edge in that cell and its next neighbours along the positive axes, so these decide. The light of
/// a surface is looked up 2.5 blocks outside of it, so bricks extend one cell farther, on all sides.
void GatherVolume::makeBricks(const Cells& occupied, std::vector<StageTime>& times) {
  const StageTimer timer(times, "bricks");
  const HierarchyLayout& hierarchy = built_.volume.hierarchy;
  const int top = hierarchy.top(), finest = std::min(shader::kSkipLevels, top);
  Cells cells = occupied;                               // one cell if the volume is smaller than a cell
  std::vector<Cells> met, around{spread(cells, 0, 1)};  // by level, starting above the finest
  for (int level = finest; level <= top; ++level) {
    met.push_back(spread(cells, 0, 1));
    around.push_back(coarserCells(spread(cells, -1, 1)));
    // Blocks above interpolated scalars are means of voxels that are classified with half the way to their neighbours.
    cells = coarserCells(level == finest && hasScalars() ? spread(cells, -1, 0) : cells);
  }

  std::vector<std::uint32_t>& numbers = cells_.numbers;
  std::vector<std::uint8_t> skips;
  constexpr int kOutside = 1 << 29;
  std::vector<glm::ivec4> bricks{glm::ivec4(kOutside)};  // the empty one
  for (int number = 0; number <= top; ++number) {
    const int brickLevel = std::min(number + shader::kBrickLevels, top), skipLevel = std::min(number + shader::kSkipLevels, top);
    const Cells& brickCells = around[std::size_t(brickLevel - finest)];
    cells_.met.push_back(met[std::size_t(skipLevel - finest)]);
    cells_.bricks.push_back(brickCells.dimensions);
    cells_.cellsPerBrick.push_back(1 << (brickLevel - skipLevel));
    const Cells skipCells = groupsToSkip(cells_.met.back());
    levels_.push_back({.dimensions = hierarchy.levels[std::size_t(number)].dimensions,
                       .firstCell = int(numbers.size()),
                       .cellStrides = brickCells.strides(),
                       .firstSkip = int(skips.size()),
                       .skipStrides = skipCells.strides(),
                       .lastSkip = skipCells.dimensions - 1});
    firstBricks_.push_back(std::uint32_t(bricks.size()));
    glm::ivec3 cell;
    for (cell.z = 0; cell.z < brickCells.dimensions.z; ++cell.z)
      for (cell.y = 0; cell.y < brickCells.dimensions.y; ++cell.y)
        for (cell.x = 0; cell.x < brickCells.dimensions.x; ++cell.x) {
          const bool isBrick = brickCells.at(cell) != 0;
          numbers.push_back(isBrick ? std::uint32_t(bricks.size()) : 0);
          if (isBrick) bricks.emplace_back(cell * shader::kGatherBrickEdge, 0);
        }
    skips.insert(skips.end(), skipCells.values.begin(), skipCells.values.end());
  }
  firstBricks_.push_back(std::uint32_t(bricks.size()));
  std::tie(brickNumbers_, brickNumberTexels_) =
      uploadTexels(device_, std::as_bytes(std::span(numbers)), VK_FORMAT_R32_UINT, "brick numbers");
  std::tie(brickCells_, brickCellTexels_) =
      uploadTexels(device_, std::as_bytes(std::span(bricks)), VK_FORMAT_R32G32B32A32_UINT, "brick cells");
  std::tie(skips_, skipTexels_) = uploadTexels(device_, std::as_bytes(std::span(skips)), VK_FORMAT_R8_UINT, "cells to skip");
}

/// Scalars without light need no source terms for voxels.
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
                               .extinctionScale = float(kStoredDepth * volume.voxelSize),
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
  return lit_ || level > 0 || !hasScalars();
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
  const bool sameSources =
      lit == lit_ && !viewDependent && !viewDependent_ && (!lit || (lighting_ == *shading.lighting && version == scatteredVersion_));
  sourceUnit_ = sourceUnit(built_.volume, lit ? shading.lighting : nullptr);
  lit_ = lit;
  viewDependent_ = viewDependent;
  scattered_ = shading.scattered;
  scatteredVersion_ = version;
  deltaScale_ = shading.frame.setup.lighting.deltaScale;
  if (shading.lighting != nullptr)
    lighting_ = *shading.lighting;
  else
    lighting_.reset();
  prepareSampled(samples ? shading.lighting : nullptr);
  wantedLevels_ = 0;
  for (int level = shading.frame.detail.finest; level <= shading.frame.detail.coarsest; ++level)
    wantedLevels_ |= 1u << level;
  if (!sameSources || hasEmissionApart() != emissionWasApart) {
    shadedLevels_ = 0;
    for (Quads& quads : quads_) quads.levels = 0;
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

std::uint64_t GatherVolume::Quads::bytes() const {
  std::uint64_t sum = medium.bytes() + source.bytes() + extra.bytes();
  for (const QuadStore& store : light) sum += store.bytes();
  return sum;
}

/// Frees quads that are out of date, and then those beyond `most` bytes.
void GatherVolume::dropOtherAxes(const std::array<bool, 3>& axes, std::uint64_t most) {
  std::uint64_t kept = 0;
  for (std::size_t axis = 0; axis < quads_.size(); ++axis) {
    Quads& quads = quads_[axis];
    if (axes[axis]) continue;
    kept += quads.bytes();
    if (quads.levels == 0 || kept > most) quads = {};
  }
}

std::uint64_t GatherVolume::QuadStore::bytes() const {
  std::uint64_t sum = 0;
  for (const Buffer& piece : pieces) sum += piece.bytes();
  return sum;
}

/// A minimal store for quads that are not needed, because a binding needs a buffer.
GatherVolume::QuadStore GatherVolume::makeStore(bool needed, std::uint64_t quadBytes, VkFormat format, const char* name) const {
  QuadStore store;
  const std::uint32_t bricks = firstBricks_.back();
  for (std::uint32_t first = 0; first == 0 || (needed && first < bricks); first += bricksPerPiece_) {
    const std::uint64_t quads = std::uint64_t(std::min(bricksPerPiece_, bricks - first)) * shader::kGatherBrickBlocks;
    store.pieces.emplace_back(device_, (needed ? quads : 1) * quadBytes, MemoryUse::Device, name, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  }
  store.texels = TexelView(device_, store.pieces.front(), format, inPieces_ ? quadBytes : VK_WHOLE_SIZE);
  return store;
}

/// Reuses the memory of an axis whose quads are out of date, if there is one.
void GatherVolume::makeRoom(Quads& quads, const std::array<bool, 3>& axes) {
  const std::uint64_t count = std::uint64_t(firstBricks_.back()) * shader::kGatherBrickBlocks;
  const auto fits = [&](const Quads& there) {
    const auto holds = [&](const QuadStore& store, bool needed, std::uint64_t bytes) {
      return store.bytes() >= (needed ? count : 1) * bytes;
    };
    for (std::size_t i = 0; i < there.light.size(); ++i)
      if (!holds(there.light[i], i < std::size_t(sampleLights()), sizeof(glm::uvec2))) return false;
    return holds(there.medium, true, sizeof(glm::uvec2)) && holds(there.source, hasColors(), sizeof(glm::uvec4)) &&
           holds(there.extra, hasTowards() || hasEmissionApart(), sizeof(glm::uvec4));
  };
  if (fits(quads)) return;
  for (std::size_t other = 0; other < axes.size(); ++other) {
    if (axes[other] || quads_[other].levels != 0 || !fits(quads_[other])) continue;
    quads = std::exchange(quads_[other], {});
    return;
  }
  quads = {};  // not both at once
  quads.medium = makeStore(true, sizeof(glm::uvec2), VK_FORMAT_R32G32_UINT, "medium quads");
  quads.source = makeStore(hasColors(), sizeof(glm::uvec4), VK_FORMAT_R32G32B32A32_UINT, "source quads");
  quads.extra = makeStore(hasTowards() || hasEmissionApart(), sizeof(glm::uvec4), VK_FORMAT_R32G32B32A32_UINT, "extra quads");
  for (std::size_t i = 0; i < quads.light.size(); ++i)
    quads.light[i] = makeStore(i < std::size_t(sampleLights()), sizeof(glm::uvec2), VK_FORMAT_R32G32_UINT, "light quads");
}

void GatherVolume::record(Commands& commands, const Shading& shading) {
  if (lacksLevels(shadedLevels_)) recordShading(commands, shading);
  if (sampleLights() > 0) recordLightCodes(commands, shading);
  if (hasSurfaces()) recordGradients(commands);
  for (int axis = 0; axis < 3; ++axis) {
    if (!shading.axes[std::size_t(axis)]) continue;
    if (lacksLevels(quads_[std::size_t(axis)].levels)) recordQuads(commands, axis);
    if (sampleLights() > 0) recordLightQuads(commands, axis);
  }
}

std::optional<shader::CodeBricks> GatherVolume::scalarCodes(int level) const {
  if (!hasScalars() || level != 0) return {};
  return built_.volume.scalarBricks->onDevice();
}

void GatherVolume::recordQuads(Commands& commands, int axis) {
  Quads& quads = quads_[std::size_t(axis)];
  commands.beginPass("brick quads");
  if (quads.levels == 0) recordBricks(commands, axis, 0, 0, 1, scalarCodes(0), quads.medium, hasColors());  // the empty one
  for (int level = 0; level <= built_.volume.hierarchy.top(); ++level)
    if (lacksLevel(quads.levels, level))
      recordBricks(commands, axis, level, firstBricks_[std::size_t(level)], firstBricks_[std::size_t(level) + 1],
                   scalarCodes(level), quads.medium, hasColors() && (lit_ || !scalarCodes(level)));
  commands.barrier(kComputeStage, kComputeStage);
  quads.levels |= wantedLevels_;
}

/// Records the quads of a level's bricks, piece by piece.
void GatherVolume::recordBricks(Commands& commands, int axis, int level, std::uint32_t first, std::uint32_t end,
                                const std::optional<shader::CodeBricks>& codes, const QuadStore& medium, bool colored) {
  if (first == end) return;
  const DeviceVolume& volume = built_.volume;
  const Quads& quads = quads_[std::size_t(axis)];
  const bool extra = (hasTowards() && colored) || (hasEmissionApart() && !codes);
  const Pipeline pass = makeComputePipeline(device_, shaders::brick_quads, {std::uint32_t(axis), extra, colored, codes.has_value()});
  const std::array<Binding, 2> bindings{&brickCellTexels_, &volume.occupancyTexels};
  for (std::uint32_t next = first; next < end;) {
    const std::uint32_t piece = next / bricksPerPiece_;
    const std::uint32_t bricks = std::min(end, (piece + 1) * bricksPerPiece_) - next;
    const shader::BrickQuadsPush push{.level = volume.onDevice(level),
                                      .firstBrick = next,
                                      .count = bricks,
                                      .firstQuad = next % bricksPerPiece_ * shader::kGatherBrickBlocks,
                                      .medium = addressWords(medium.address(piece)),
                                      .source = addressWords(quads.source.address(piece)),
                                      .extra = addressWords(quads.extra.address(piece)),
                                      .sources = addressWords(sources_.address()),
                                      .extras = addressWords(extras_.address()),
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
    if (lacksLevel(shadedLevels_, level) && shadesLevel(level)) shade(commands, shading, level);
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
  for (int number = frame.finest; number <= frame.coarsest; ++number) frame.levels[number] = levels_[std::size_t(number)];
}

std::vector<GatherBlocks> GatherVolume::downloadBlocks() const {
  const DeviceVolume& volume = built_.volume;
  std::vector<GatherBlocks> levels(std::size_t(volume.hierarchy.top()) + 1);
  for (int level = 0; level <= volume.hierarchy.top(); ++level) {
    if ((wantedLevels_ >> level & 1u) == 0 || (level == 0 && hasScalars())) continue;
    const GridLayout& grid = volume.hierarchy.levels[std::size_t(level)];
    const std::vector<std::uint32_t> indices = downloadStored(device_, volume, level);
    std::vector<glm::uvec2> stored(indices.size());
    std::vector<std::uint32_t> emission(hasEmissionApart() ? indices.size() : 0);
    if (!stored.empty())
      download(device_, sources_, std::as_writable_bytes(std::span(stored)), volume.firstRank(level) * sizeof(glm::uvec2));
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
