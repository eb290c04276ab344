#include "engine/storage/fvx_file.h"

#include <xxhash.h>

#include <cstring>
#include <vector>

#include "engine/storage/baked_volume.h"
#include "tests/fuzz/fuzz_file.h"

namespace {

using namespace freevoxels;

using Bytes = std::vector<std::uint8_t>;

bool holds(const Bytes& bytes, std::uint64_t offset, std::uint64_t count) {
  return offset <= bytes.size() && count <= bytes.size() - offset;
}

/// Gives every entry of an index of chunks or regions the hash of what it refers to.
template <typename Entry>
void repairEntries(Bytes& bytes, const fvx::Section& index) {
  for (std::uint64_t at = index.offset; at + sizeof(Entry) <= index.offset + index.bytes; at += sizeof(Entry)) {
    Entry entry;
    std::memcpy(&entry, &bytes[at], sizeof(entry));
    if (!holds(bytes, entry.offset, entry.storedBytes)) continue;
    entry.hash = XXH3_64bits(bytes.data() + entry.offset, entry.storedBytes);
    std::memcpy(&bytes[at], &entry, sizeof(entry));
  }
}

/// Without correct hashes, nothing that was mutated would be read any further than its hash.
void repairHashes(Bytes& bytes) {
  fvx::Header header;
  if (bytes.size() < sizeof(header)) return;
  std::memcpy(&header, bytes.data(), sizeof(header));
  header.identifier = fvx::kIdentifier;
  header.fileBytes = bytes.size();
  for (std::size_t i = 0; i < std::min<std::size_t>(header.sectionCount, fvx::kMaxSections); ++i) {
    fvx::Section& section = header.sections[i];
    if (!holds(bytes, section.offset, section.bytes) || section.offset < sizeof(header)) continue;
    if (section.kind == fvx::SectionKind::ChunkIndex) repairEntries<fvx::ChunkEntry>(bytes, section);
    if (section.kind == fvx::SectionKind::RegionIndex) repairEntries<fvx::RegionEntry>(bytes, section);
    section.hash = XXH3_64bits(bytes.data() + section.offset, section.bytes);
  }
  header.hash = 0;
  header.hash = XXH3_64bits(&header, sizeof(header));
  std::memcpy(bytes.data(), &header, sizeof(header));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::uint64_t kMaxVoxels = 1 << 20;
  Bytes bytes(data, data + size);
  repairHashes(bytes);
  const fuzz::FuzzFile bytesAsFile(bytes.data(), bytes.size());
  fuzz::tryTo([&] {
    const auto file = std::make_shared<const fvx::FvxFile>(bytesAsFile.path());
    for (int level = 0; level < file->levels(); ++level)
      for (const fvx::RegionEntry& region : file->regions(level)) fuzz::tryTo([&] { readBakedRegion(*file, region); });
    fuzz::tryTo([&] { file->checkAll(); });
    readBaked(file, finestLevel(*file, kMaxVoxels));
  });
  return 0;
}
