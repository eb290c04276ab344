#include "engine/storage/fvx_file.h"

#include <tbb/parallel_for.h>
#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <memory>

#include "engine/core/error.h"
#include "engine/storage/chunk_pyramid.h"

namespace freevoxels::fvx {

namespace {

namespace fs = std::filesystem;

std::uint64_t hashOf(std::span<const std::byte> bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

bool hasIdentifier(const void* bytes) {
  return std::memcmp(bytes, kIdentifier.data(), kIdentifier.size()) == 0;
}

}  // namespace

bool isFvx(const fs::path& file) {
  if (file.extension() == ".fvx") return true;
  std::array<char, kIdentifier.size()> first{};
  std::ifstream stream(file, std::ios::binary);
  return stream.read(first.data(), first.size()) && hasIdentifier(first.data());
}

std::uint64_t hashOfFile(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> hash(XXH3_createState(), XXH3_freeState);
  XXH3_64bits_reset(hash.get());
  std::vector<char> piece(std::size_t(1) << 20);
  do {
    stream.read(piece.data(), std::streamsize(piece.size()));
    XXH3_64bits_update(hash.get(), piece.data(), std::size_t(stream.gcount()));
  } while (stream);
  if (!stream.eof()) fail(ErrorKind::Input, "cannot read '{}'; check its name and its permissions", file.string());
  return XXH3_64bits_digest(hash.get());
}

FvxFile::FvxFile(const fs::path& file) : path_(file) {
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  if (error) fail(ErrorKind::Input, "cannot read '{}': {}; check its name", file.string(), error.message());
  if (size == 0) fail(ErrorKind::Input, "'{}' is empty; copy it again, or bake it again", file.string());
  try {
    map_.open(file.string());
  } catch (const std::exception&) {
    fail(ErrorKind::Input, "cannot read '{}': it cannot be mapped into memory; check its permissions", file.string());
  }
  checkHeader();
  const std::span<const std::byte> description = required(SectionKind::Description, "description");
  description_ = parseDescription({reinterpret_cast<const char*>(description.data()), description.size()}, file);
  const std::span<const std::byte> provenance = required(SectionKind::Provenance, "provenance");
  provenance_ = {reinterpret_cast<const char*>(provenance.data()), provenance.size()};
  content_ = readContent();
  dimensions_ = levelDimensions(description_.volume.dimensions);
  chunks_.resize(dimensions_.size());
  for (int level = 0; level < levels(); ++level)
    for (std::size_t channel = 0; channel < kChannels; ++channel)
      if (hasChannel(Channel(channel))) chunks_[std::size_t(level)][channel] = readIndex(Channel(channel), level);
}

void FvxFile::failDamaged(const std::string& what) const {
  fail(ErrorKind::Input, "'{}' is damaged: {}; copy it again, or bake it again", path_.string(), what);
}

void FvxFile::checkHeader() const {
  const std::uint64_t size = map_.size();
  const std::string name = path_.string();
  if (size < kIdentifier.size() || !hasIdentifier(map_.data()))
    fail(ErrorKind::Input, "'{}' is no baked volume: it does not begin as one; 'freevoxels bake' makes them", name);
  if (size < sizeof(Header))
    fail(ErrorKind::Input, "'{}' is incomplete: it has {} bytes, and its header alone {}; copy it again", name, size, sizeof(Header));
  if (header().byteOrderMark == kOtherByteOrderMark)
    fail(ErrorKind::Input, "'{}' cannot be read: it was written on a machine with the other byte order", name);
  if (header().majorVersion != kMajorVersion)
    fail(ErrorKind::Input, "'{}' cannot be read: it has format {}.{}, and this program reads format {}; bake it again", name,
         header().majorVersion, header().minorVersion, kMajorVersion);
  Header unhashed = header();
  unhashed.hash = 0;
  if (XXH3_64bits(&unhashed, sizeof(unhashed)) != header().hash) failDamaged("the checksum of its header is wrong");
  if (size < header().fileBytes)
    fail(ErrorKind::Input, "'{}' is incomplete: it has {} of {} bytes; copy it again", name, size, header().fileBytes);
  if (size > header().fileBytes) failDamaged(fmt::format("it has {} bytes instead of {}", size, header().fileBytes));
  if (header().byteOrderMark != kByteOrderMark || header().sectionCount > kMostSections) failDamaged("its header is impossible");
  for (const Section& section : sections())
    if (section.offset % kPageBytes != 0 || section.offset > size || section.bytes > size - section.offset)
      failDamaged("a section is not where it should be");
}

const Section* FvxFile::find(SectionKind kind, Channel channel, int level) const {
  const auto all = sections();
  const auto found = std::ranges::find_if(all, [&](const Section& section) {
    return section.kind == kind && section.channel == channel && int(section.level) == level;
  });
  return found == all.end() ? nullptr : &*found;
}

std::span<const std::byte> FvxFile::checked(const Section& section) const {
  const std::span<const std::byte> result = bytes(section.offset, section.bytes);
  if (hashOf(result) != section.hash)
    failDamaged(fmt::format("the checksum of a section (kind {}, level {}) is wrong", std::uint32_t(section.kind), section.level));
  return result;
}

std::span<const std::byte> FvxFile::required(SectionKind kind, const char* name) const {
  const Section* const section = find(kind);
  if (section == nullptr) failDamaged(fmt::format("it has no {}", name));
  return checked(*section);
}

ContentCells FvxFile::readContent() const {
  const std::span<const std::byte> raw = required(SectionKind::ContentCells, "content cells");
  ContentHeader header;
  if (raw.size() < sizeof(header)) failDamaged("its content cells are too short");
  std::memcpy(&header, raw.data(), sizeof(header));
  constexpr int kMostCells = 1 << 10;
  const glm::ivec3 cells = header.cells;
  const bool possible = glm::all(glm::greaterThan(cells, glm::ivec3(0))) && glm::all(glm::lessThan(cells, glm::ivec3(kMostCells)));
  const std::uint64_t count = possible ? std::uint64_t(cells.x) * std::uint64_t(cells.y) * std::uint64_t(cells.z) : 0;
  if (!possible || raw.size() != sizeof(header) + (count + 7) / 8 || !(header.edge > 0.0)) failDamaged("its content cells are impossible");
  ContentCells content{.cells = Cells(cells), .edge = header.edge};
  for (std::size_t i = 0; i < count; ++i)
    content.cells.values[i] = std::uint8_t(std::to_integer<int>(raw[sizeof(header) + i / 8]) >> i % 8 & 1);
  return content;
}

std::span<const ChunkEntry> FvxFile::readIndex(Channel channel, int level) const {
  const Section* const index = find(SectionKind::ChunkIndex, channel, level);
  const Section* const chunks = find(SectionKind::Chunks, channel, level);
  if (index == nullptr || chunks == nullptr) failDamaged(fmt::format("it has no chunks of level {}", level));
  const std::span<const std::byte> raw = checked(*index);
  if (raw.size() % sizeof(ChunkEntry) != 0) failDamaged("the index of its chunks ends in the middle of one");
  const std::span entries(reinterpret_cast<const ChunkEntry*>(raw.data()), raw.size() / sizeof(ChunkEntry));
  for (const ChunkEntry& entry : entries) checkEntry(entry, *chunks, channel, level);
  return entries;
}

void FvxFile::checkEntry(const ChunkEntry& entry, const Section& chunks, Channel channel, int level) const {
  const glm::ivec3 cells = (dimensions(level) + kChunkEdge - 1) / kChunkEdge;
  const bool inside = entry.offset >= chunks.offset && entry.offset - chunks.offset <= chunks.bytes &&
                      entry.storedBytes <= chunks.bytes - (entry.offset - chunks.offset) && entry.offset % kChunkAlignment == 0;
  const bool inBox = glm::all(glm::greaterThanEqual(entry.cell, glm::ivec3(0))) && glm::all(glm::lessThan(entry.cell, cells));
  const std::uint64_t expected = std::uint64_t(entry.bricks()) * description_.brickBytes(channel);
  const bool stored = entry.codec == Codec::None ? entry.storedBytes == entry.bytes : entry.codec == Codec::PlanesZstd;
  if (!inside || !inBox || !stored || entry.bytes != expected)
    failDamaged(fmt::format("the entry of chunk {},{},{} of level {} is impossible", entry.cell.x, entry.cell.y, entry.cell.z, level));
}

std::span<const std::byte> FvxFile::read(Channel channel, const ChunkEntry& chunk, std::vector<std::byte>& unpacked) const {
  const std::span<const std::byte> stored = bytes(chunk.offset, chunk.storedBytes);
  const auto failChunk = [&](const char* what) {
    failDamaged(fmt::format("{} of chunk {},{},{} at byte {}", what, chunk.cell.x, chunk.cell.y, chunk.cell.z, chunk.offset));
  };
  if (hashOf(stored) != chunk.hash) failChunk("the checksum is wrong");
  if (chunk.codec == Codec::None) return stored;
  std::vector<std::byte> planes(chunk.bytes);
  if (ZSTD_decompress(planes.data(), planes.size(), stored.data(), stored.size()) != planes.size())
    failChunk("the compressed bytes are wrong");
  unpacked.resize(planes.size());
  const std::size_t width = description_.encodings[std::size_t(channel)]->bytesPerValue(), values = planes.size() / width;
  for (std::size_t plane = 0; plane < width; ++plane)
    for (std::size_t i = 0; i < values; ++i) unpacked[i * width + plane] = planes[plane * values + i];
  return unpacked;
}

void FvxFile::checkAll() const {
  for (const Section& section : sections()) checked(section);
  for (int level = 0; level < levels(); ++level)
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      const std::span<const ChunkEntry> all = chunks(Channel(channel), level);
      tbb::parallel_for(std::size_t(0), all.size(), [&](std::size_t i) {
        std::vector<std::byte> unpacked;
        read(Channel(channel), all[i], unpacked);
      });
    }
}

}  // namespace freevoxels::fvx
