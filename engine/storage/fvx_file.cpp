#include "engine/storage/fvx_file.h"

#include <sys/mman.h>
#include <tbb/parallel_for.h>
#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <memory>

#include "engine/core/error.h"
#include "engine/storage/chunk_pyramid.h"
#include "engine/storage/hilbert.h"
#include "engine/storage/plane_codec.h"

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
  // What is read is said exactly: the kernel's own guesses are of megabytes.
  madvise(const_cast<char*>(map_.data()), size, MADV_RANDOM);
  checkHeader();
  const std::span<const std::byte> description = required(SectionKind::Description, "description");
  description_ = parseDescription({reinterpret_cast<const char*>(description.data()), description.size()}, file);
  const std::span<const std::byte> provenance = required(SectionKind::Provenance, "provenance");
  provenance_ = {reinterpret_cast<const char*>(provenance.data()), provenance.size()};
  description_.volume.content = std::make_shared<const Subject>(subjectOf(readContent(), description_.volume));
  dimensions_ = levelDimensions(description_.volume.dimensions);
  chunks_.resize(dimensions_.size());
  for (int level = 0; level < levels(); ++level)
    for (std::size_t channel = 0; channel < kChannels; ++channel)
      if (hasChannel(Channel(channel))) chunks_[std::size_t(level)][channel] = readIndex(Channel(channel), level);
  readRegions();
}

std::span<const std::byte> FvxFile::bytes(std::uint64_t offset, std::uint64_t count) const {
  const std::uint64_t first = offset / kPageBytes * kPageBytes;
  madvise(const_cast<char*>(map_.data()) + first, offset + count - first, MADV_WILLNEED);
  return std::as_bytes(std::span(map_.data() + offset, count));
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
  if (header().byteOrderMark != kByteOrderMark || header().sectionCount > kMaxSections) failDamaged("its header is impossible");
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
  constexpr int kMaxCells = 1 << 10;
  const glm::ivec3 cells = header.cells;
  const bool possible = glm::all(glm::greaterThan(cells, glm::ivec3(0))) && glm::all(glm::lessThan(cells, glm::ivec3(kMaxCells)));
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

std::span<const std::byte> FvxFile::unpack(std::uint64_t offset, std::uint64_t storedBytes, std::uint64_t size, std::uint64_t hash,
                                           Codec codec, std::size_t bytesPerValue, std::vector<std::byte>& unpacked,
                                           const std::string& what) const {
  const std::span<const std::byte> stored = bytes(offset, storedBytes);
  if (hashOf(stored) != hash) failDamaged(fmt::format("the checksum of {} at byte {} is wrong", what, offset));
  if (codec == Codec::None) return stored;
  unpacked.resize(size);
  if (!decompressPlanes(stored, bytesPerValue, unpacked)) failDamaged(fmt::format("the compressed bytes of {} at byte {} are wrong", what, offset));
  return unpacked;
}

std::span<const std::byte> FvxFile::read(Channel channel, const ChunkEntry& chunk, std::vector<std::byte>& unpacked) const {
  return unpack(chunk.offset, chunk.storedBytes, chunk.bytes, chunk.hash, chunk.codec,
                description_.encodings[std::size_t(channel)]->bytesPerValue(), unpacked,
                fmt::format("chunk {},{},{}", chunk.cell.x, chunk.cell.y, chunk.cell.z));
}

const ChunkEntry* FvxFile::find(Channel channel, int level, glm::ivec3 cell) const {
  const std::span<const ChunkEntry> all = chunks(channel, level);
  const int bits = hilbertBits((dimensions(level) + kChunkEdge - 1) / kChunkEdge);
  const auto place = [&](glm::ivec3 c) { return hilbertIndex(glm::uvec3(c), bits); };
  const auto found = std::ranges::lower_bound(all, place(cell), {}, [&](const ChunkEntry& entry) { return place(entry.cell); });
  return found == all.end() || found->cell != cell ? nullptr : &*found;
}

std::uint64_t FvxFile::bytesToRead(const RegionEntry& region) const {
  std::uint64_t bytes = region.storedBytes;
  for (std::size_t channel = 0; channel < kChannels; ++channel)
    for (int child = 0; child < 8; ++child) {
      const glm::ivec3 cell = 2 * region.cell + glm::ivec3(child & 1, child >> 1 & 1, child >> 2);
      if (const ChunkEntry* const chunk = find(Channel(channel), int(region.level), cell)) bytes += chunk->storedBytes;
    }
  return bytes;
}

RegionSurroundings FvxFile::readRegion(const RegionEntry& region) const {
  std::vector<std::byte> unpacked;
  const std::span<const std::byte> bytes =
      unpack(region.offset, region.storedBytes, region.bytes, region.hash, region.codec, sizeof(std::uint16_t), unpacked,
             fmt::format("region {},{},{} of level {}", region.cell.x, region.cell.y, region.cell.z, region.level));
  return decodeRegion(region.cell, dimensions(int(region.level)), region.parts, *description_.encodings[std::size_t(Channel::Scalars)], bytes);
}

void FvxFile::checkEntry(const RegionEntry& entry, const Section& regions) const {
  const auto impossible = [&] {
    failDamaged(fmt::format("the entry of region {},{},{} of level {} is impossible", entry.cell.x, entry.cell.y, entry.cell.z, entry.level));
  };
  if (entry.level >= dimensions_.size() || entry.parts >= 2 * kHaloPart) impossible();
  const glm::ivec3 size = dimensions(int(entry.level)), cells = regionCells(size);
  if (glm::any(glm::lessThan(entry.cell, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(entry.cell, cells))) impossible();
  const std::uint64_t expected =
      regionBytes(entry.cell, size, entry.parts, *description_.encodings[std::size_t(Channel::Scalars)]);
  const bool inside = entry.offset >= regions.offset && entry.offset - regions.offset <= regions.bytes &&
                      entry.storedBytes <= regions.bytes - (entry.offset - regions.offset) && entry.offset % kChunkAlignment == 0;
  const bool stored = entry.codec == Codec::None ? entry.storedBytes == entry.bytes : entry.codec == Codec::PlanesZstd;
  if (!inside || !stored || entry.bytes != expected) impossible();
}

void FvxFile::readRegions() {
  regions_.resize(dimensions_.size());
  const Section* const index = find(SectionKind::RegionIndex);
  if (index == nullptr) return;
  const Section* const regions = find(SectionKind::Regions);
  const std::span<const std::byte> raw = checked(*index);
  if (regions == nullptr || raw.size() % sizeof(RegionEntry) != 0) failDamaged("the index of its regions does not fit them");
  const std::span entries(reinterpret_cast<const RegionEntry*>(raw.data()), raw.size() / sizeof(RegionEntry));
  for (std::size_t first = 0, end = 0; first < entries.size(); first = end) {
    for (end = first; end < entries.size() && entries[end].level == entries[first].level; ++end) checkEntry(entries[end], *regions);
    std::span<const RegionEntry>& ofLevel = regions_[entries[first].level];
    if (!ofLevel.empty()) failDamaged("the index of its regions is out of order");
    ofLevel = entries.subspan(first, end - first);
  }
  for (int level = 0; level < levels(); ++level) {
    std::size_t next = 0;
    for (const ChunkEntry& chunk : chunks(Channel::Scalars, level)) {
      const glm::ivec3 region = chunk.cell * kChunkEdge / kRegionEdge;
      const std::span<const RegionEntry> known = regions_[std::size_t(level)];
      if (next < known.size() && known[next].cell == region) ++next;
      if (next == 0 || known[next - 1].cell != region) failDamaged(fmt::format("a region of level {} is missing in the index", level));
    }
  }
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
  for (int level = 0; level < levels(); ++level)
    for (const RegionEntry& region : regions(level)) readRegion(region);
}

}  // namespace freevoxels::fvx
