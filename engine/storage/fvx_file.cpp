#include "engine/storage/fvx_file.h"

#include <tbb/parallel_for.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>
#include <system_error>
#include <tuple>

#include "engine/core/error.h"
#include "engine/core/json_file.h"
#include "engine/octree/hilbert.h"
#include "engine/storage/chunk_pyramid.h"
#include "engine/storage/chunk_reader.h"
#include "engine/storage/fvx_index.h"
#include "engine/storage/plane_codec.h"

namespace freevoxels::fvx {

namespace {

namespace fs = std::filesystem;

/// Bytes that are read and hashed at a time.
constexpr std::size_t kPieceBytes = std::size_t(1) << 20;

class Hash {
 public:
  Hash() { XXH3_64bits_reset(state_.get()); }
  void add(std::span<const std::byte> bytes) { XXH3_64bits_update(state_.get(), bytes.data(), bytes.size()); }
  std::uint64_t value() const { return XXH3_64bits_digest(state_.get()); }

 private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_{XXH3_createState(), XXH3_freeState};
};

std::uint64_t hashOf(std::span<const std::byte> bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

bool hasIdentifier(const void* bytes) {
  return std::memcmp(bytes, kIdentifier.data(), kIdentifier.size()) == 0;
}

[[noreturn]] void failToRead(const fs::path& file, const std::system_error& error) {
  fail(ErrorKind::Input, "cannot read '{}': {}; check its name and its permissions", file.string(), error.code().message());
}

RandomAccessFile openFile(const fs::path& file) {
  try {
    return RandomAccessFile(file);
  } catch (const std::system_error& error) {
    failToRead(file, error);
  }
}

}  // namespace

bool isFvx(const fs::path& file) {
  if (file.extension() == ".fvx") return true;
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return false;  // opening a pipe would wait for somebody to write to it
  std::array<char, kIdentifier.size()> first{};
  std::ifstream stream(file, std::ios::binary);
  return stream.read(first.data(), first.size()) && hasIdentifier(first.data());
}

std::uint64_t hashOfFile(const fs::path& file) {
  try {
    const RandomAccessFile opened(file);
    Hash hash;
    std::vector<std::byte> piece(kPieceBytes);
    std::uint64_t offset = 0;
    for (std::size_t count = piece.size(); count == piece.size(); offset += count) {
      count = opened.readAt(offset, piece);
      hash.add(std::span(piece).first(count));
    }
    return hash.value();
  } catch (const std::system_error& error) {
    failToRead(file, error);
  }
}

FvxFile::FvxFile(const fs::path& file) : path_(file), file_(openFile(file)) {
  if (file_.bytes() == 0) fail(ErrorKind::Input, "'{}' is empty; copy it again, or bake it again", file.string());
  readHeader();
  checkHeader();
  checkSections();
  const std::vector<char> description = required(SectionKind::Description, "description");
  description_ = parseDescription({description.data(), description.size()}, file);
  const std::vector<char> provenance = required(SectionKind::Provenance, "provenance");
  provenance_.assign(provenance.begin(), provenance.end());
  if (isTooDeep(provenance_)) failDamaged(fmt::format("its provenance is nested more than {} deep", kDeepestJson));
  description_.volume.content = std::make_shared<const Subject>(subjectOf(readContent(), description_.volume));
  dimensions_ = levelDimensions(description_.volume.dimensions);
  for (std::size_t channel = 0; channel < kChannels; ++channel) readChannel(Channel(channel));
}

void FvxFile::failDamaged(const std::string& what) const {
  if (file_.hasChanged())
    fail(ErrorKind::Input, "'{}' was overwritten or cut while it was in use; open it again, and give new files their names when they are complete",
         path_.string());
  fail(ErrorKind::Input, "'{}' is damaged: {}; copy it again, or bake it again", path_.string(), what);
}

void FvxFile::readBytes(std::uint64_t offset, std::span<std::byte> bytes) const {
  std::size_t count = 0;
  try {
    count = file_.readAt(offset, bytes);
  } catch (const std::system_error& error) {
    fail(ErrorKind::Input, "cannot read '{}': {}; check the disk or the network", path_.string(), error.code().message());
  }
  if (count != bytes.size()) failDamaged(fmt::format("it ends at byte {}", offset + count));
}

void FvxFile::readHeader() {
  const auto bytes = std::as_writable_bytes(std::span(&header_, 1)).first(std::min<std::uint64_t>(sizeof(header_), file_.bytes()));
  std::memset(static_cast<void*>(&header_), 0, sizeof(header_));
  readBytes(0, bytes);
}

void FvxFile::checkHeader() const {
  const std::uint64_t size = file_.bytes();
  const std::string name = path_.string();
  if (size < kIdentifier.size() || !hasIdentifier(&header_))
    fail(ErrorKind::Input, "'{}' is no baked volume: it does not begin as one; 'freevoxels bake' makes them", name);
  if (size < sizeof(Header))
    fail(ErrorKind::Input, "'{}' is incomplete: it has {} bytes, and its header alone {}; copy it again", name, size, sizeof(Header));
  if (header_.byteOrderMark == kOtherByteOrderMark)
    fail(ErrorKind::Input, "'{}' cannot be read: it was written on a machine with the other byte order", name);
  if (header_.majorVersion != kMajorVersion)
    fail(ErrorKind::Input, "'{}' cannot be read: it has format {}.{}, and this program reads format {}; bake it again", name,
         header_.majorVersion, header_.minorVersion, kMajorVersion);
  Header unhashed = header_;
  unhashed.hash = 0;
  if (XXH3_64bits(&unhashed, sizeof(unhashed)) != header_.hash) failDamaged("the checksum of its header is wrong");
  if (size < header_.fileBytes)
    fail(ErrorKind::Input, "'{}' is incomplete: it has {} of {} bytes; copy it again", name, size, header_.fileBytes);
  if (size > header_.fileBytes) failDamaged(fmt::format("it has {} bytes instead of {}", size, header_.fileBytes));
  if (header_.byteOrderMark != kByteOrderMark || header_.sectionCount > kMaxSections) failDamaged("its header is impossible");
}

/// Sections of unknown kinds may lie anywhere in the file; those of known kinds have a place of their own.
void FvxFile::checkSections() const {
  std::vector<Section> known;
  for (const Section& section : sections()) {
    if (section.offset % kPageBytes != 0 || section.offset > file_.bytes() || section.bytes > file_.bytes() - section.offset)
      failDamaged("a section is not where it should be");
    if (section.kind >= SectionKind::Description && section.kind <= SectionKind::ContentCells) known.push_back(section);
  }
  std::ranges::sort(known, {}, [](const Section& section) { return std::tuple(section.offset, section.bytes); });
  std::uint64_t free = sizeof(Header);
  for (const Section& section : known) {
    if (section.bytes > 0 && section.offset < free) failDamaged("two sections are in the same place");
    free = std::max(free, section.offset + section.bytes);
  }
  const auto what = [](const Section& section) { return std::tuple(section.kind, section.channel, section.level); };
  std::ranges::sort(known, {}, what);
  if (std::ranges::adjacent_find(known, {}, what) != known.end()) failDamaged("it has a section twice");
}

const Section* FvxFile::find(SectionKind kind, Channel channel, int level) const {
  const auto all = sections();
  const auto found = std::ranges::find_if(all, [&](const Section& section) {
    return section.kind == kind && section.channel == channel && int(section.level) == level;
  });
  return found == all.end() ? nullptr : &*found;
}

void FvxFile::failSectionHash(const Section& section) const {
  failDamaged(fmt::format("the checksum of a section (kind {}, level {}) is wrong", std::uint32_t(section.kind), section.level));
}

void FvxFile::checkHash(const Section& section) const {
  Hash hash;
  std::vector<std::byte> piece(std::min<std::uint64_t>(kPieceBytes, section.bytes));
  for (std::uint64_t done = 0; done < section.bytes; done += piece.size()) {
    piece.resize(std::min<std::uint64_t>(piece.size(), section.bytes - done));
    readBytes(section.offset + done, piece);
    hash.add(piece);
  }
  if (hash.value() != section.hash) failSectionHash(section);
}

template <typename Value>
std::vector<Value> FvxFile::valuesOf(const Section& section) const {
  if (section.bytes % sizeof(Value) != 0) failDamaged("an index ends in the middle of an entry");
  std::vector<Value> values(section.bytes / sizeof(Value));
  const std::span<std::byte> bytes = std::as_writable_bytes(std::span(values));
  readBytes(section.offset, bytes);
  if (hashOf(bytes) != section.hash) failSectionHash(section);
  return values;
}

std::vector<char> FvxFile::required(SectionKind kind, const char* name) const {
  const Section* const section = find(kind);
  if (section == nullptr) failDamaged(fmt::format("it has no {}", name));
  return valuesOf<char>(*section);
}

/// Cells may be a little fewer or more than the volume's edge divided by theirs: those of a volume that is baked in parts are of a sample.
ContentCells FvxFile::readContent() const {
  const std::vector<char> raw = required(SectionKind::ContentCells, "content cells");
  ContentHeader header;
  if (raw.size() < sizeof(header)) failDamaged("its content cells are too short");
  std::memcpy(&header, raw.data(), sizeof(header));
  constexpr int kMaxCells = 1 << 10;
  const glm::ivec3 cells = header.cells;
  bool possible = std::isfinite(header.edge) && header.edge > 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double expected = double(description_.volume.dimensions[axis]) / header.edge;
    possible = possible && cells[axis] > 0 && cells[axis] < kMaxCells && cells[axis] <= 2.0 * expected + 2.0 && cells[axis] >= 0.5 * expected - 2.0;
  }
  const std::uint64_t count = possible ? std::uint64_t(cells.x) * std::uint64_t(cells.y) * std::uint64_t(cells.z) : 0;
  if (!possible || raw.size() != sizeof(header) + (count + 7) / 8) failDamaged("its content cells are impossible");
  ContentCells content{.cells = Cells(cells), .edge = header.edge};
  for (std::size_t i = 0; i < count; ++i)
    content.cells.values[i] = std::uint8_t(std::uint8_t(raw[sizeof(header) + i / 8]) >> i % 8 & 1);
  return content;
}

void FvxFile::readChannel(Channel channel) {
  std::vector<std::vector<ChunkEntry>>& ofLevels = chunks_[std::size_t(channel)];
  ofLevels.resize(dimensions_.size());
  if (!hasChannel(channel)) return;
  const auto refuse = [&](std::size_t level, const std::string& why) {
    if (!why.empty()) failDamaged(fmt::format("in channel {}, level {}, {}", std::uint32_t(channel), level, why));
  };
  for (std::size_t level = 0; level < ofLevels.size(); ++level) {
    const Section* const index = find(SectionKind::ChunkIndex, channel, int(level));
    const Section* const chunks = find(SectionKind::Chunks, channel, int(level));
    if (index == nullptr || chunks == nullptr) failDamaged(fmt::format("it has no chunks of level {}", level));
    ofLevels[level] = valuesOf<ChunkEntry>(*index);
    refuse(level, whyNotChunks(ofLevels[level], {.dimensions = dimensions_[level],
                                                 .chunks = *chunks,
                                                 .brickBytes = description_.brickBytes(channel),
                                                 .range = description_.valueRange(channel, int(level))}));
    if (level > 0) refuse(level, whyNotLevels(ofLevels[level - 1], ofLevels[level]));
  }
  std::uint64_t active = 0;
  for (const ChunkEntry& chunk : ofLevels.front()) active += chunk.activeVoxels;
  if (active > description_.activeVoxels(channel)) refuse(0, "the chunks count more voxels than the volume has");
}

std::span<const std::byte> FvxFile::read(Channel channel, const ChunkEntry& chunk, ReadBuffers& buffers) const {
  buffers.stored.resize(chunk.storedBytes);
  read(chunk, std::span(buffers.stored));
  if (chunk.codec == Codec::None) return buffers.stored;
  buffers.unpacked.resize(chunk.bytes);
  if (!decompressPlanes(buffers.stored, description_.encodings[std::size_t(channel)]->bytesPerValue(), buffers.planes, buffers.unpacked))
    failDamaged(fmt::format("the compressed bytes of {} at byte {} are wrong", nameOf(chunk), chunk.offset));
  return buffers.unpacked;
}

void FvxFile::read(const ChunkEntry& chunk, std::span<std::byte> bytes) const {
  FV_CHECK_EQ(bytes.size(), chunk.storedBytes);
  readBytes(chunk.offset, bytes);
  if (hashOf(bytes) != chunk.hash) failDamaged(fmt::format("the checksum of {} at byte {} is wrong", nameOf(chunk), chunk.offset));
}

const ChunkEntry* FvxFile::find(Channel channel, int level, glm::ivec3 cell) const {
  const std::span<const ChunkEntry> all = chunks(channel, level);
  const int bits = hilbertBits(chunkCells(dimensions(level)));
  const auto place = [&](glm::ivec3 c) { return hilbertIndex(glm::uvec3(c), bits); };
  const auto found = std::ranges::lower_bound(all, place(cell), {}, [&](const ChunkEntry& entry) { return place(entry.cell); });
  return found == all.end() || found->cell != cell ? nullptr : &*found;
}

void FvxFile::checkAll() const {
  for (const Section& section : sections()) checkHash(section);
  for (std::size_t channel = 0; channel < kChannels; ++channel)
    for (int level = 0; level < levels() && hasChannel(Channel(channel)); ++level) {
      const ChunkReader reader(*this, Channel(channel), level);
      const std::span<const ChunkEntry> all = chunks(Channel(channel), level);
      tbb::parallel_for(std::size_t(0), all.size(), [&](std::size_t i) { reader.check(all[i]); });
    }
}

}  // namespace freevoxels::fvx
