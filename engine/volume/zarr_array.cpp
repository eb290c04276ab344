#include "engine/volume/zarr_array.h"

#include <tbb/parallel_for.h>

#include <fmt/ranges.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <limits>
#include <type_traits>

#include "engine/volume/scan_reader.h"

namespace freevoxels {

namespace {

constexpr std::uint64_t kAbsent = ~std::uint64_t(0);  ///< in the index of a shard, where a chunk is the fill value

/// The extent along x, y and z of what an array has along its axes.
glm::ivec3 alongBox(const ZarrBox& box, const std::vector<std::uint64_t>& extents) {
  glm::ivec3 result(1);
  for (int axis = 0; axis < 3; ++axis)
    if (const int of = box.axes[std::size_t(axis)]; of >= 0) result[axis] = int(std::min<std::uint64_t>(extents[std::size_t(of)], 1 << 30));
  return result;
}

float halfAt(const std::byte* place, bool isBigEndian) {
  const auto low = std::uint16_t(place[isBigEndian ? 1 : 0]), high = std::uint16_t(place[isBigEndian ? 0 : 1]);
  return glm::unpackHalf1x16(std::uint16_t(low | high << 8));
}

/// Whether numbers of a type can be so.
bool isNumberOf(SampleType type, float number) {
  return withSampleType(type, [&](auto typed) {
    using Value = decltype(typed);
    if constexpr (std::is_floating_point_v<Value>) return true;
    using Limits = std::numeric_limits<Value>;
    return number >= float(Limits::lowest()) && number < float(Limits::max()) + 1.0f && number == std::floor(number);
  });
}

}  // namespace

/// A chunk: where its bytes are.
struct ZarrArray::Piece {
  glm::ivec3 chunk{0};                     ///< its number along x, y and z
  std::shared_ptr<const StoredFile> file;  ///< null: all its values are the fill value
  std::string name;
  std::uint64_t offset = 0, bytes = 0;
};

std::string ZarrArray::nameOf(const std::vector<std::uint64_t>& shard) const {
  return (folder_.empty() ? "" : folder_ + "/") + layout_.keyPrefix + fmt::format("{}", fmt::join(shard, layout_.keySeparator));
}

std::vector<std::uint64_t> ZarrArray::indexOf(const std::string& name, const StoredFile& file) const {
  std::uint64_t chunks = 1;
  for (std::size_t axis = 0; axis < layout_.shape.size(); ++axis) chunks *= layout_.shard[axis] / layout_.chunk[axis];
  const std::uint64_t bytes = 16 * chunks + (layout_.indexHasChecksum ? 4 : 0);
  if (bytes > file.bytes()) failDamaged(store_.shown(name), "it is too short for the index of a shard");
  std::vector<std::byte> packed(bytes);
  if (!file.readAt(layout_.indexIsAtStart ? 0 : file.bytes() - bytes, packed)) failDamaged(store_.shown(name), "it ends too early");
  constexpr ChunkCodec kChecksum[] = {ChunkCodec::Crc32c};
  const std::span<const ChunkCodec> codecs(kChecksum, layout_.indexHasChecksum ? 1 : 0);
  const std::vector<std::byte> plain = decodedChunk(std::move(packed), codecs, 16 * chunks, store_.shown(name));
  std::vector<std::uint64_t> numbers(2 * chunks);
  for (std::size_t i = 0; i < plain.size(); ++i) numbers[i / 8] |= std::uint64_t(plain[i]) << (8 * (i % 8));
  return numbers;
}

/// The chunks of the file that has the shard of this number along x, y and z.
std::vector<ZarrArray::Piece> ZarrArray::piecesOf(const ZarrBox& box, glm::ivec3 shard) const {
  std::vector<std::uint64_t> number(layout_.shape.size());
  for (std::size_t axis = 0; axis < number.size(); ++axis) number[axis] = box.place[axis] / layout_.shard[axis];
  for (int axis = 0; axis < 3; ++axis)
    if (box.axes[std::size_t(axis)] >= 0) number[std::size_t(box.axes[std::size_t(axis)])] = std::uint64_t(shard[axis]);
  const std::string name = nameOf(number);
  const std::shared_ptr<const StoredFile> file = store_.open(name, kAbsent);
  const std::vector<std::uint64_t> index = file && layout_.isSharded ? indexOf(name, *file) : std::vector<std::uint64_t>();
  const glm::ivec3 perShard = alongBox(box, layout_.shard) / alongBox(box, layout_.chunk);
  const glm::ivec3 all = (alongBox(box, layout_.shape) - 1) / alongBox(box, layout_.chunk) + 1;
  const glm::ivec3 first = shard * perShard, size = alongBox(box, layout_.chunk);
  const glm::ivec3 begin = glm::max(first, box.first / size), end = glm::min(glm::min(first + perShard, all), box.last / size + 1);
  std::vector<Piece> pieces;
  for (glm::ivec3 chunk = begin; chunk.z < end.z; ++chunk.z)
    for (chunk.y = begin.y; chunk.y < end.y; ++chunk.y)
      for (chunk.x = begin.x; chunk.x < end.x; ++chunk.x) {
        Piece piece{.chunk = chunk, .file = file, .name = name, .bytes = file ? file->bytes() : 0};
        if (!index.empty()) {
          std::uint64_t at = 0;
          for (std::size_t axis = 0; axis < number.size(); ++axis) {
            std::uint64_t inShard = box.place[axis] % layout_.shard[axis] / layout_.chunk[axis];
            for (int k = 0; k < 3; ++k)
              if (box.axes[std::size_t(k)] == int(axis)) inShard = std::uint64_t(chunk[k] - first[k]);
            at = at * (layout_.shard[axis] / layout_.chunk[axis]) + inShard;
          }
          piece.offset = index[2 * at];
          piece.bytes = index[2 * at + 1];
          if (piece.offset == kAbsent && piece.bytes == kAbsent) piece.file = nullptr;
        }
        pieces.push_back(std::move(piece));
      }
  return pieces;
}

std::vector<std::byte> ZarrArray::bytesOfPiece(const Piece& piece) const {
  const std::uint64_t most = 2 * layout_.bytesOfChunk() + (std::uint64_t(1) << 16);  // what does not compress becomes a little longer
  const std::string shown = store_.shown(piece.name);
  if (piece.offset > piece.file->bytes() || piece.bytes > piece.file->bytes() - piece.offset)
    failDamaged(shown, "the index of its shard is wrong");
  if (piece.bytes > most) failDamaged(shown, fmt::format("it has a chunk of {} bytes, which takes {} at most", piece.bytes, most));
  std::vector<std::byte> packed(piece.bytes);
  if (!piece.file->readAt(piece.offset, packed)) failDamaged(shown, "it ends too early");
  return decodedChunk(std::move(packed), layout_.codecs, layout_.bytesOfChunk(), shown);
}

void ZarrArray::readPiece(const ZarrBox& box, const Piece& piece, const SampleSink& sink) const {
  SampleBlock block{.type = layout_.type, .first = piece.chunk * alongBox(box, layout_.chunk)};
  block.extent = glm::min(alongBox(box, layout_.chunk), alongBox(box, layout_.shape) - block.first);
  const std::size_t count = std::size_t(block.extent.x) * std::size_t(block.extent.y) * std::size_t(block.extent.z);
  if (layout_.isHalf || (!piece.file && !isNumberOf(layout_.type, layout_.fill))) block.type = SampleType::F32;
  std::vector<std::byte> samples(count * bytesOf(block.type));
  block.samples = samples.data();
  if (!piece.file) {
    withSampleType(block.type, [&](auto typed) {
      const auto fill = decltype(typed)(layout_.fill);
      for (std::size_t i = 0; i < count; ++i) std::memcpy(samples.data() + i * sizeof(fill), &fill, sizeof(fill));
    });
    return sink(block);
  }
  const std::vector<std::byte> plain = bytesOfPiece(piece);
  std::uint64_t begin = 0;
  for (std::size_t axis = 0; axis < layout_.shape.size(); ++axis)
    if (std::ranges::find(box.axes, int(axis)) == box.axes.end()) begin += box.place[axis] % layout_.chunk[axis] * layout_.strides[axis];
  const auto strideOf = [&](std::size_t axis) { return box.axes[axis] < 0 ? 0 : layout_.strides[std::size_t(box.axes[axis])]; };
  const std::uint64_t bytes = layout_.bytesOfValue(), along = strideOf(0);
  std::byte* target = samples.data();
  for (int z = 0; z < block.extent.z; ++z)
    for (int y = 0; y < block.extent.y; ++y) {
      const std::byte* source = plain.data() + (begin + std::uint64_t(y) * strideOf(1) + std::uint64_t(z) * strideOf(2)) * bytes;
      for (int x = 0; x < block.extent.x; ++x, source += along * bytes, target += bytesOf(block.type)) {
        if (layout_.isHalf) {
          const float value = halfAt(source, layout_.isBigEndian);
          std::memcpy(target, &value, sizeof(value));
        } else {
          std::memcpy(target, source, bytes);
        }
      }
    }
  block.isSwapped = !layout_.isHalf && layout_.isBigEndian != (std::endian::native == std::endian::big);
  sink(block);
}

std::size_t ZarrArray::piecesAtOnce() const {
  constexpr std::uint64_t kBytes = std::uint64_t(256) << 20, kMost = 128;
  return std::size_t(std::clamp<std::uint64_t>(kBytes / layout_.bytesOfChunk(), 1, kMost));
}

std::uint64_t ZarrArray::bytesToRead() const {
  return 3 * layout_.bytesOfChunk() * piecesAtOnce();
}

void ZarrArray::read(const ZarrBox& box, const SampleSink& sink, const Progress& progress) const {
  const glm::ivec3 size = alongBox(box, layout_.shard), first = box.first / size;
  const glm::ivec3 last = glm::min(alongBox(box, layout_.shape) - 1, box.last) / size, shards = last - first + 1;
  const double all = double(shards.x) * double(shards.y) * double(shards.z);
  double done = 0.0;
  std::vector<Piece> pieces;
  const auto readThem = [&] {
    for (std::size_t begin = 0; begin < pieces.size(); begin += piecesAtOnce()) {
      if (progress) progress("reading the scan", done / all);
      const std::size_t end = std::min(begin + piecesAtOnce(), pieces.size());
      tbb::parallel_for(begin, end, [&](std::size_t i) { readPiece(box, pieces[i], sink); });
    }
    pieces.clear();
  };
  for (glm::ivec3 shard = first; shard.z <= last.z; ++shard.z)
    for (shard.y = first.y; shard.y <= last.y; ++shard.y)
      for (shard.x = first.x; shard.x <= last.x; ++shard.x, ++done) {
        std::vector<Piece> more = piecesOf(box, shard);
        std::ranges::move(more, std::back_inserter(pieces));
        if (pieces.size() >= piecesAtOnce()) readThem();
      }
  readThem();
}

}  // namespace freevoxels
