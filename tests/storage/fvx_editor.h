#pragma once
// Changes the numbers of a baked volume and repairs its checksums, as somebody does who wants a reader to believe him.

#include <gtest/gtest.h>
#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "engine/storage/fvx_format.h"
#include "tests/temporary_folder.h"

namespace freevoxels::test {

class FvxEditor {
 public:
  explicit FvxEditor(std::string bytes) : bytes_(std::move(bytes)) {}

  fvx::Header& header() { return *reinterpret_cast<fvx::Header*>(bytes_.data()); }
  /// Null if there is none.
  fvx::Section* section(fvx::SectionKind kind, fvx::Channel channel = {}, int level = 0) {
    for (fvx::Section& section : std::span(header().sections).first(header().sectionCount))
      if (section.kind == kind && section.channel == channel && int(section.level) == level) return &section;
    return nullptr;
  }
  template <typename Value>
  std::span<Value> valuesOf(const fvx::Section& section) {
    return {reinterpret_cast<Value*>(bytes_.data() + section.offset), section.bytes / sizeof(Value)};
  }
  std::span<fvx::ChunkEntry> chunks(int level = 0, fvx::Channel channel = fvx::Channel::Scalars) {
    return valuesOf<fvx::ChunkEntry>(*section(fvx::SectionKind::ChunkIndex, channel, level));
  }
  template <typename Value>
  std::span<Value> storedValues(const fvx::ChunkEntry& entry) {
    return {reinterpret_cast<Value*>(bytes_.data() + entry.offset), entry.storedBytes / sizeof(Value)};
  }
  std::string text(fvx::SectionKind kind) {
    const std::span<char> characters = valuesOf<char>(*section(kind));
    return {characters.begin(), characters.end()};
  }
  /// Takes the page of a section and the following ones away from what follows it, if it needs them.
  void setText(fvx::SectionKind kind, const std::string& text) {
    fvx::Section& changed = *section(kind);
    const auto pages = [](std::uint64_t bytes) { return (bytes + fvx::kPageBytes - 1) / fvx::kPageBytes * fvx::kPageBytes; };
    const std::uint64_t before = pages(changed.bytes), after = std::max(pages(text.size()), before), more = after - before;
    bytes_.insert(changed.offset + before, more, '\0');
    fvx::Section& moved = *section(kind);
    for (fvx::Section& other : std::span(header().sections).first(header().sectionCount)) {
      if (&other == &moved || other.offset <= moved.offset) continue;
      other.offset += more;
      if (other.kind == fvx::SectionKind::ChunkIndex)
        for (fvx::ChunkEntry& entry : valuesOf<fvx::ChunkEntry>(other)) entry.offset += more;
    }
    std::ranges::copy(text, bytes_.begin() + std::ptrdiff_t(moved.offset));
    moved.bytes = text.size();
  }

  void save(const std::filesystem::path& file) {
    for (fvx::Section& section : std::span(header().sections).first(header().sectionCount)) {
      if (section.offset > bytes_.size() || section.bytes > bytes_.size() - section.offset) continue;
      if (section.kind == fvx::SectionKind::ChunkIndex) repair(valuesOf<fvx::ChunkEntry>(section));
      section.hash = XXH3_64bits(bytes_.data() + section.offset, section.bytes);
    }
    header().fileBytes = bytes_.size();
    header().hash = 0;
    header().hash = XXH3_64bits(&header(), sizeof(fvx::Header));
    writeBytes(file, bytes_);
  }

 private:
  void repair(std::span<fvx::ChunkEntry> entries) {
    for (fvx::ChunkEntry& entry : entries)
      if (entry.offset <= bytes_.size() && entry.storedBytes <= bytes_.size() - entry.offset)
        entry.hash = XXH3_64bits(bytes_.data() + entry.offset, entry.storedBytes);
  }

  std::string bytes_;
};

}  // namespace freevoxels::test
