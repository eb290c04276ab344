#include "engine/storage/baked_volume.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <new>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/octree/device_volume.h"
#include "engine/octree/hilbert.h"
#include "engine/storage/chunk_reader.h"
#include "engine/storage/fvx_writer.h"
#include "engine/volume/transfer_table.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

namespace {

using fvx::Channel;
using fvx::ChunkEntry;
using fvx::ChunkValues;
using fvx::EncodingKind;
using fvx::FvxFile;

/// Chunks that are held at a time, and that one process of a team encodes in turn.
constexpr std::size_t kBatchChunks = 16;

fvx::Encoding scalarEncoding(const Volume& volume, glm::vec2 range, const Classification& classification, bool keepScalars) {
  if (keepScalars) return {};
  if (!classification.transferFunction) {
    const double depth = kStoredDepth * volume.voxelSize() * classification.densityScale;
    return {.kind = EncodingKind::Float16, .scale = depth > 0.0 ? 1.0 / depth : 1.0};
  }
  const TransferTable table(*classification.transferFunction, range[0], range[1]);
  return {.kind = EncodingKind::Linear16,
          .scale = (table.high() - table.low()) / shader::kScalarCodes,
          .offset = table.low()};
}

fvx::Encodings encodingsOf(const Volume& volume, glm::vec2 range, const Classification& classification, bool keepScalars) {
  fvx::Encodings encodings;
  encodings[std::size_t(Channel::Scalars)] = scalarEncoding(volume, range, classification, keepScalars);
  // Emission grows with a high power of the temperature.
  if (volume.temperature) encodings[std::size_t(Channel::Temperature)] = fvx::Encoding{};
  if (volume.albedo)
    encodings[std::size_t(Channel::Albedo)] =
        fvx::Encoding{.kind = keepScalars ? EncodingKind::Float32 : EncodingKind::Float16};
  return encodings;
}

/// Fills a brick that begins at a voxel of the box. Returns false if none of its voxels has a value.
bool copyBrick(const ScalarBricks& scalars, glm::ivec3 first, float* values) {
  constexpr int n = ScalarBricks::kEdge;
  const glm::ivec3 end = glm::min(scalars.dimensions() - first, n);
  if (scalars.corner() == glm::ivec3(0) && end == glm::ivec3(n)) {
    const std::optional<std::size_t> brick = scalars.numberAt(first / n);
    if (brick) std::ranges::copy(scalars.brick(*brick), values);
    return brick.has_value();
  }
  bool any = false;
  for (glm::ivec3 v(0); v.z < end.z; ++v.z)
    for (v.y = 0; v.y < end.y; ++v.y)
      for (v.x = 0; v.x < end.x; ++v.x) {
        const float value = scalars.at(first + v);
        values[ScalarBricks::indexInBrick(v)] = value;
        any = any || value != kInactiveVoxel;
      }
  return any;
}

/// Empty if no voxel has a value.
std::vector<float> chunkOf(std::span<const ScalarBricks* const> components, glm::ivec3 cell) {
  std::vector<float> values(components.size() * fvx::kChunkVoxels, kInactiveVoxel);
  bool any = false;
  for (std::size_t component = 0; component < components.size(); ++component)
    for (int brick = 0; brick < fvx::kChunkBricks; ++brick) {
      const glm::ivec3 first = cell * fvx::kChunkEdge + ScalarBricks::kEdge * fvx::cellInChunk(brick);
      if (glm::any(glm::greaterThanEqual(first, components[component]->dimensions()))) continue;
      float* const to = &values[(component * fvx::kChunkBricks + std::size_t(brick)) * fvx::kBrickVoxels];
      any = copyBrick(*components[component], first, to) || any;
    }
  if (!any) values.clear();
  return values;
}

ChunkValues chunkOf(const Volume& volume, glm::ivec3 cell) {
  ChunkValues chunk{.cell = cell};
  fvx::forEachChannel(volume,
                      [&](Channel channel, const auto& components) { chunk.channels[std::size_t(channel)] = chunkOf(components, cell); });
  return chunk;
}

/// Adds the classification, and the counts and ranges of the chunks where they are missing.
Volume summarised(Volume outline, const Classification& classification, bool fixed, const fvx::FvxWriter& writer) {
  const auto complete = [&](Channel channel, auto& grid) {
    if (grid.activeVoxels != 0) return;
    const fvx::FvxWriter::Summary sum = writer.summary(channel);
    grid.activeVoxels = sum.activeVoxels;
    grid.minimum = sum.minimum;
    grid.maximum = sum.maximum;
  };
  complete(Channel::Scalars, outline);
  if (outline.temperature) complete(Channel::Temperature, *outline.temperature);
  outline.classification = std::make_shared<const Classification>(classification);
  outline.classificationIsFixed = fixed;
  return outline;
}

/// The positions of the bricks of a channel's chunks, and the number of bricks before each chunk.
struct BrickPlaces {
  std::vector<glm::ivec3> cells;
  std::vector<std::size_t> first;  ///< by chunk

  explicit BrickPlaces(std::span<const ChunkEntry> chunks) {
    for (const ChunkEntry& chunk : chunks) {
      first.push_back(cells.size());
      for (int brick = 0; brick < fvx::kChunkBricks; ++brick)
        if (chunk.hasBrick(brick)) cells.push_back(chunk.brickCell(brick));
    }
  }
};

/// One set of bricks for each value of a voxel.
std::vector<ScalarBricks> readChannel(const FvxFile& file, Channel channel, int level, const Progress& progress) {
  const std::span<const ChunkEntry> chunks = file.chunks(channel, level);
  const BrickPlaces places(chunks);
  const std::size_t count = places.cells.size(), components = file.description().valuesPerVoxel(channel);
  const fvx::ChunkReader reader(file, channel, level);
  std::vector<ScalarBricks::Bricks> bricks(components);
  for (ScalarBricks::Bricks& values : bricks) values.resize(count);
  const auto readChunk = [&](std::size_t i) {
    if (components == 1) return reader.readAll(chunks[i], std::span(bricks.front()).subspan(places.first[i], std::size_t(chunks[i].bricks())));
    reader.read(chunks[i], [&](std::size_t number, std::size_t component) { return &bricks[component][places.first[i] + number]; });
  };
  constexpr std::size_t kBatch = 256;  // chunks, of 128 KiB of values each
  for (std::size_t first = 0; first < chunks.size(); first += kBatch) {
    if (progress) progress("reading the file", double(first) / double(chunks.size()));
    tbb::parallel_for(first, std::min(first + kBatch, chunks.size()), readChunk);
  }
  std::vector<ScalarBricks> result;
  for (ScalarBricks::Bricks& values : bricks)
    result.push_back(ScalarBricks::of(file.dimensions(level), places.cells, std::move(values)));
  return result;
}

std::uint64_t activeVoxels(std::span<const ChunkEntry> chunks) {
  std::uint64_t sum = 0;
  for (const ChunkEntry& chunk : chunks) sum += chunk.activeVoxels;
  return sum;
}

/// Makes the blocks of a level the voxels of a volume.
void makeCoarse(Volume& volume, const FvxFile& file, int level) {
  volume.indexToWorld = fvx::levelToWorld(volume.indexToWorld, level);
  volume.dimensions = file.dimensions(level);
  volume.indexOrigin = glm::ivec3(0);
  volume.activeVoxels = activeVoxels(file.chunks(Channel::Scalars, level));
  if (volume.temperature) volume.temperature->activeVoxels = activeVoxels(file.chunks(Channel::Temperature, level));
}

Volume readLevel(const FvxFile& file, int level, const Progress& progress) {
  Volume volume = bakedOutline(file, level);
  fvx::forEachChannel(volume, [&](Channel channel, const auto& components) {
    std::vector<ScalarBricks> read = readChannel(file, channel, level, progress);
    for (std::size_t i = 0; i < read.size(); ++i) *components[i] = std::move(read[i]);
  });
  return volume;
}

/// Encodes this process's stretches of the chunks. The one that has the writer adds them all, in order; while it adds one, the others
/// encode theirs.
void encodeInTurn(std::span<const glm::ivec3> cells, const ChunkSource& chunk, const fvx::WriteSettings& settings, const BakeTeam& team,
                  fvx::FvxWriter* writer, const Progress& progress) {
  int owner = 0;
  for (std::size_t first = 0; first < cells.size(); first += kBatchChunks, owner = (owner + 1) % team.count) {
    if (progress) progress("baking", double(first) / double(cells.size()));
    std::vector<std::byte> encoded;
    if (owner == team.index) {
      std::vector<ChunkValues> batch(std::min(kBatchChunks, cells.size() - first));
      tbb::parallel_for(std::size_t(0), batch.size(), [&](std::size_t i) { batch[i] = chunk(cells[first + i]); });
      encoded = fvx::encodeChunks(settings, batch);
    }
    if (owner != 0 && (owner == team.index || writer != nullptr)) team.bring(encoded, owner);
    if (writer != nullptr) writer->add(encoded);
  }
}

/// The cells of the chunks in which a volume has bricks.
std::vector<glm::ivec3> occupiedChunks(const Volume& volume) {
  SparseGrid<std::uint8_t> chunks((volume.dimensions + fvx::kChunkEdge - 1) / fvx::kChunkEdge);
  const auto add = [&](const ScalarBricks& values) {
    for (std::size_t brick = 0; brick < values.count(); ++brick) {
      const glm::ivec3 place = values.firstVoxel(brick);
      const glm::ivec3 low = glm::max(place, 0) / fvx::kChunkEdge;
      const glm::ivec3 high = glm::min(place + ScalarBricks::kEdge - 1, volume.dimensions - 1) / fvx::kChunkEdge;
      for (glm::ivec3 cell = low; cell.z <= high.z; ++cell.z)
        for (cell.y = low.y; cell.y <= high.y; ++cell.y)
          for (cell.x = low.x; cell.x <= high.x; ++cell.x) chunks[cell] = 1;
    }
  };
  forEachGrid(add, volume);
  std::vector<glm::ivec3> cells;
  chunks.forEach([&](glm::ivec3 cell, std::uint8_t) { cells.push_back(cell); });
  return cells;
}

}  // namespace

StreamedVolume partsStream(const VdbParts& parts, const Classification& classification) {
  return {.outline = parts.outline(),
          .content = contentCellsOf(parts.outline().dimensions, parts.sample(), classification),
          .range = {parts.outline().minimum, parts.outline().maximum},
          .cells = parts.occupied(fvx::kChunkEdge),
          .chunk = [&parts](glm::ivec3 cell) {
            ChunkValues chunk = chunkOf(parts.read(cell * fvx::kChunkEdge, fvx::kChunkEdge), glm::ivec3(0));
            chunk.cell = cell;
            return chunk;
          }};
}

void bakeStreamed(const std::filesystem::path& file, const StreamedVolume& volume, const Classification& classification,
                  const BakeSettings& settings, const Progress& progress, const BakeTeam& team) {
  const glm::ivec3 dimensions = volume.outline.dimensions;
  const int longest = std::max({dimensions.x, dimensions.y, dimensions.z});
  if (longest > fvx::kLongestEdge)
    fail(ErrorKind::Input, "{} is too long for a baked volume: {} voxels, and at most {} are possible; crop or resample it",
         volume.outline.source, longest, fvx::kLongestEdge);
  const bool densities = !classification.transferFunction;
  const fvx::WriteSettings write{
      .dimensions = dimensions,
      .encodings = encodingsOf(volume.outline, volume.range, classification, settings.keepScalars),
      .withoutData = densities ? WithoutData::Zero : WithoutData::Ignored,
      .leaveOutZeros = densities && !settings.keepScalars,
      .compress = settings.compress};
  std::vector<glm::ivec3> cells = volume.cells;
  sortAlongHilbert(cells, (dimensions + fvx::kChunkEdge - 1) / fvx::kChunkEdge);
  const auto spread = [&](fvx::FvxWriter* writer) {
    encodeInTurn(cells, volume.chunk, write, team, writer, progress);
  };
  if (team.index != 0) return spread(nullptr);
  writeAtomically(file, [&](const std::filesystem::path& temporary) {
    fvx::FvxWriter writer(file.has_parent_path() ? file.parent_path() : ".", write);
    spread(&writer);
    const fvx::Description description{.volume = summarised(volume.outline, classification, !settings.keepScalars, writer),
                                       .encodings = write.encodings};
    if (progress) progress(kWritingStage, 0.0);
    writer.finish(temporary, description, volume.content, settings.provenance);
  });
}

void bakeVolume(const std::filesystem::path& file, const Volume& volume, const Classification& classification,
                const BakeSettings& settings, const Progress& progress, const BakeTeam& team) {
  bakeStreamed(file,
               {.outline = outlineOf(volume),
                .content = contentCells(volume, classification),
                .range = {volume.minimum, volume.maximum},
                .cells = occupiedChunks(volume),
                .chunk = [&](glm::ivec3 cell) { return chunkOf(volume, cell); }},
               classification, settings, progress, team);
}

Volume bakedOutline(const FvxFile& file, int level) {
  Volume volume = file.description().volume;
  volume.source = fmt::format("{} ({})", file.path().filename().string(), volume.source);
  if (level > 0) makeCoarse(volume, file, level);
  return volume;
}

Volume readBaked(const std::shared_ptr<const FvxFile>& file, int level, const Progress& progress) {
  FV_CHECK_LT(level, file->levels());
  try {
    return readLevel(*file, level, progress);
  } catch (const std::bad_alloc&) {
    fail(ErrorKind::OutOfMemory, "not enough memory for level {} of '{}'; free some", level, file->path().string());
  }
}

int finestLevel(const fvx::FvxFile& file, std::uint64_t maximumVoxels) {
  for (int level = 0; level < file.levels(); ++level) {
    const glm::dvec3 n(file.dimensions(level));
    std::uint64_t bricks = 0;
    for (const ChunkEntry& chunk : file.chunks(Channel::Scalars, level)) bricks += std::uint64_t(chunk.bricks());
    if (n.x * n.y * n.z <= double(maximumVoxels) || bricks * fvx::kBrickVoxels <= maximumVoxels) return level;
  }
  fail(ErrorKind::OutOfMemory, "'{}' is too large: not even its coarsest level fits into {} voxels; raise {}",
       file.path().string(), maximumVoxels, Parameter("memory-limit"));
}

}  // namespace freevoxels
