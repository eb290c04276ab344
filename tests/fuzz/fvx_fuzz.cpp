#include "engine/storage/fvx_file.h"

#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <vector>

#include "engine/storage/baked_source.h"
#include "engine/storage/baked_volume.h"
#include "engine/volume/coarse_cells.h"
#include "engine/volume/histogram.h"
#include "engine/volume/scattering_medium.h"
#include "shaders/gather_interface.h"
#include "tests/fuzz/fuzz_file.h"

/// Of libFuzzer and of replay.cpp: changes bytes, and returns how many there are.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* bytes, std::size_t size, std::size_t maximum);

namespace {

using namespace freevoxels;

using Bytes = std::vector<std::uint8_t>;

bool holds(std::size_t size, std::uint64_t offset, std::uint64_t count) {
  return offset <= size && count <= size - offset;
}

/// The sections of a file that lie in it.
std::vector<fvx::Section> sectionsOf(const std::uint8_t* bytes, std::size_t size) {
  std::vector<fvx::Section> sections;
  fvx::Header header;
  if (size < sizeof(header)) return sections;
  std::memcpy(&header, bytes, sizeof(header));
  for (std::size_t i = 0; i < std::min<std::size_t>(header.sectionCount, fvx::kMaxSections); ++i)
    if (const fvx::Section& section = header.sections[i]; holds(size, section.offset, section.bytes) && section.offset >= sizeof(header))
      sections.push_back(section);
  return sections;
}

/// The bytes of a brick of which most entries of an index have whole numbers, as many as bits in their masks.
std::uint64_t brickBytesOf(std::span<const fvx::ChunkEntry> entries) {
  std::uint64_t found = 0;
  std::ptrdiff_t most = 0;
  for (const std::uint64_t valueBytes : {2, 4, 3 * 2, 3 * 4}) {
    const std::uint64_t bytes = fvx::kBrickVoxels * valueBytes;
    const auto count = std::ranges::count_if(entries, [&](const fvx::ChunkEntry& entry) { return entry.bytes == std::uint64_t(entry.bricks()) * bytes; });
    if (count > most) most = count, found = bytes;
  }
  return found;
}

/// The number of bits of a mask is stored a second time, as the number of bytes of the bricks: bits are changed, the highest ones first,
/// until it is right, so that a mutated mask is read any further.
void repairMask(fvx::ChunkEntry& entry, std::uint64_t brickBytes) {
  const std::uint64_t wanted = std::min<std::uint64_t>(entry.bytes / brickBytes, fvx::kChunkBricks);
  for (std::uint64_t bit = std::uint64_t(1) << 63; bit != 0 && std::uint64_t(entry.bricks()) != wanted; bit >>= 1)
    if ((std::uint64_t(entry.bricks()) < wanted) == ((entry.brickMask & bit) == 0)) entry.brickMask ^= bit;
}

void repairMasks(std::span<fvx::ChunkEntry> entries) {
  const std::uint64_t brickBytes = brickBytesOf(entries);
  if (brickBytes == 0) return;
  for (fvx::ChunkEntry& entry : entries) repairMask(entry, brickBytes);
}

/// Gives every entry of an index the hash of what it refers to.
void repairEntries(Bytes& bytes, const fvx::Section& index) {
  std::vector<fvx::ChunkEntry> entries(index.bytes / sizeof(fvx::ChunkEntry));
  if (entries.empty()) return;
  std::memcpy(entries.data(), &bytes[index.offset], entries.size() * sizeof(fvx::ChunkEntry));
  repairMasks(entries);
  for (fvx::ChunkEntry& entry : entries)
    if (holds(bytes.size(), entry.offset, entry.storedBytes)) entry.hash = XXH3_64bits(bytes.data() + entry.offset, entry.storedBytes);
  std::memcpy(&bytes[index.offset], entries.data(), entries.size() * sizeof(fvx::ChunkEntry));
}

/// Without correct hashes, nothing that was mutated would be read any further than its hash.
void repairHashes(Bytes& bytes) {
  fvx::Header header;
  if (bytes.size() < sizeof(header)) return;
  for (const fvx::Section& section : sectionsOf(bytes.data(), bytes.size()))
    if (section.kind == fvx::SectionKind::ChunkIndex) repairEntries(bytes, section);
  std::memcpy(&header, bytes.data(), sizeof(header));
  header.identifier = fvx::kIdentifier;
  header.fileBytes = bytes.size();
  for (fvx::Section& section : header.sections)
    if (holds(bytes.size(), section.offset, section.bytes) && section.offset >= sizeof(header))
      section.hash = XXH3_64bits(bytes.data() + section.offset, section.bytes);
  header.hash = 0;
  header.hash = XXH3_64bits(&header, sizeof(header));
  std::memcpy(bytes.data(), &header, sizeof(header));
}

/// Exchanges the bit of a brick that is there with that of one that is not.
void moveBrick(std::uint8_t* entry, std::mt19937& random) {
  std::uint64_t mask = 0;
  std::memcpy(&mask, entry + offsetof(fvx::ChunkEntry, brickMask), sizeof(mask));
  const std::uint64_t from = std::uint64_t(1) << random() % 64, to = std::uint64_t(1) << random() % 64;
  if ((mask & from) != 0 && (mask & to) == 0) mask ^= from | to;
  std::memcpy(entry + offsetof(fvx::ChunkEntry, brickMask), &mask, sizeof(mask));
}

/// Changes a number of an entry of an index, exchanges two entries, or moves a brick.
void mutateIndex(std::uint8_t* index, std::uint64_t bytes, std::mt19937& random) {
  constexpr std::size_t kEntry = sizeof(fvx::ChunkEntry);
  const std::size_t count = bytes / kEntry;
  if (count == 0) return;
  std::uint8_t* const entry = index + random() % count * kEntry;
  switch (random() % 4) {
    case 0:
      std::swap_ranges(entry, entry + kEntry, index + random() % count * kEntry);
      break;
    case 1:
      moveBrick(entry, random);
      break;
    default:
      LLVMFuzzerMutate(entry + random() % (kEntry / 4) * 4, 4, 4);
  }
}

/// What drawing computes of a volume on the host before it needs a device.
void prepareToDraw(const Volume& volume) {
  constexpr int kBins = 256;
  const Classification& classification = *volume.classification;
  histogramOf(volume, kBins);
  ScatteringMedium(volume, classification).coarser();
  for (const int edge : {1, 2, 1 << shader::kSkipLevels}) metCells(volume, classification, edge);
}

}  // namespace

/// The numbers of a file are a small part of its bytes, of which most are values and zeros between sections.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* bytes, std::size_t size, std::size_t maximum, unsigned seed) {
  std::mt19937 random(seed);
  const std::vector<fvx::Section> sections = sectionsOf(bytes, size);
  if (sections.empty() || random() % 4 == 0) return LLVMFuzzerMutate(bytes, size, maximum);
  const fvx::Section& section = sections[random() % sections.size()];
  std::uint8_t* const first = bytes + section.offset;
  switch (section.kind) {
    case fvx::SectionKind::ChunkIndex:
      mutateIndex(first, section.bytes, random);
      break;
    default:
      if (section.bytes == 0) return LLVMFuzzerMutate(bytes, size, maximum);
      LLVMFuzzerMutate(first, section.bytes, section.bytes);
  }
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::uint64_t kMaxVoxels = 1 << 20;
  Bytes bytes(data, data + size);
  repairHashes(bytes);
  const fuzz::FuzzFile bytesAsFile(bytes.data(), bytes.size());
  fuzz::tryTo([&] {
    const auto file = std::make_shared<const fvx::FvxFile>(bytesAsFile.path());
    fuzz::tryTo([&] { file->checkAll(); });
    const int level = finestLevel(*file, kMaxVoxels);
    fuzz::tryTo([&] { prepareToDraw(readBaked(file, level)); });
    const glm::ivec3 end = file->dimensions(level), middle = end / 2 & ~(ScalarBricks::kEdge - 1);
    fuzz::tryTo([&] { prepareToDraw(BakedSource(file).read(level, {middle, end})); });
  });
  return 0;
}
