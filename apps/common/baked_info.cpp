#include "apps/common/baked_info.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/common/text_table.h"
#include "engine/core/printable.h"

namespace freevoxels {

namespace {

using fvx::Channel;
using fvx::ChunkEntry;
using fvx::FvxFile;
using fvx::SectionKind;
using Json = nlohmann::ordered_json;

constexpr std::array<const char*, fvx::kChannels> kChannelNames{"scalars", "temperature", "albedo"};

std::string channelName(Channel channel) {
  return std::size_t(channel) < kChannelNames.size() ? kChannelNames[std::size_t(channel)] : fmt::format("{}", std::uint32_t(channel));
}

std::string kindName(SectionKind kind) {
  switch (kind) {
    case SectionKind::Description: return "description";
    case SectionKind::Provenance: return "provenance";
    case SectionKind::ChunkIndex: return "chunk index";
    case SectionKind::Chunks: return "chunks";
    case SectionKind::ContentCells:
      return "content cells";
  }
  return fmt::format("unknown {}", std::uint32_t(kind));
}

bool ofChunks(const fvx::Section& section) {
  return section.kind == SectionKind::ChunkIndex || section.kind == SectionKind::Chunks;
}

/// Sums over the chunks of a level.
struct LevelSums {
  std::size_t chunks = 0;
  std::uint64_t bricks = 0, activeVoxels = 0, storedBytes = 0, bytes = 0;
};

LevelSums sumsOf(std::span<const ChunkEntry> chunks) {
  LevelSums sums{.chunks = chunks.size()};
  for (const ChunkEntry& chunk : chunks) {
    sums.bricks += std::uint64_t(chunk.bricks());
    sums.activeVoxels += chunk.activeVoxels;
    sums.storedBytes += chunk.storedBytes;
    sums.bytes += chunk.bytes;
  }
  return sums;
}

/// Bytes of the file per active voxel of the finest level, for all channels and levels together.
double bytesPerVoxel(const FvxFile& file) {
  const std::uint64_t voxels = sumsOf(file.chunks(Channel::Scalars, 0)).activeVoxels;
  return double(file.header().fileBytes) / double(std::max<std::uint64_t>(voxels, 1));
}

TextTable sectionTable(const FvxFile& file) {
  using enum TextTable::Align;
  TextTable table{.columns = {Left, Left, Right, Right, Right, Left},
                  .rows = {{"SECTION", "CHANNEL", "LEVEL", "OFFSET", "BYTES", "XXH3-64"}}};
  for (const fvx::Section& section : file.sections())
    table.rows.push_back({kindName(section.kind), ofChunks(section) ? channelName(section.channel) : "-",
                          ofChunks(section) ? fmt::format("{}", section.level) : "-", fmt::format("{}", section.offset),
                          fmt::format("{}", section.bytes), fmt::format("{:016x}", section.hash)});
  return table;
}

TextTable levelTable(const FvxFile& file) {
  using enum TextTable::Align;
  TextTable table{.columns = {Right, Left, Left, Right, Right, Right, Right, Right},
                  .rows = {{"LEVEL", "CHANNEL", "DIMENSIONS", "CHUNKS", "BRICKS", "ACTIVE VOXELS", "STORED", "UNPACKED"}}};
  for (int level = file.levels() - 1; level >= 0; --level)
    for (int channel = 0; channel < fvx::kChannels; ++channel) {
      if (!file.hasChannel(Channel(channel))) continue;
      const LevelSums sums = sumsOf(file.chunks(Channel(channel), level));
      const glm::ivec3 size = file.dimensions(level);
      table.rows.push_back({fmt::format("{}", level), channelName(Channel(channel)), fmt::format("{}x{}x{}", size.x, size.y, size.z),
                            fmt::format("{}", sums.chunks), fmt::format("{}", sums.bricks), fmt::format("{}", sums.activeVoxels),
                            fmt::format("{}", sums.storedBytes), fmt::format("{}", sums.bytes)});
    }
  return table;
}

/// As a text where it is no JSON.
Json provenanceJson(const FvxFile& file) {
  const Json json = Json::parse(file.provenance(), nullptr, false);
  return json.is_discarded() ? Json(std::string(file.provenance())) : json;
}

}  // namespace

void printBaked(const FvxFile& file) {
  const fvx::Header& header = file.header();
  const Volume& volume = file.description().volume;
  fmt::print("{}: baked volume of format {}.{}, {} bytes, {:.2f} for each active voxel\n", printable(file.path().string()), header.majorVersion,
             header.minorVersion, header.fileBytes, bytesPerVoxel(file));
  fmt::print("volume: {}, {}x{}x{} voxels, values {:.4g}..{:.4g}, classification {}\n", volume.source, volume.dimensions.x,
             volume.dimensions.y, volume.dimensions.z, volume.minimum, volume.maximum,
             volume.classificationIsFixed ? "fixed" : "can be changed");
  for (std::size_t channel = 0; channel < fvx::kChannels; ++channel)
    if (const auto& encoding = file.description().encodings[channel])
      fmt::print("channel {}: {}\n", kChannelNames[channel], fvx::kEncodingNames[std::size_t(encoding->kind)]);
  fmt::print("provenance: {}\n\n", printable(file.provenance()));
  for (const std::string& line : levelTable(file).lines()) fmt::print("{}\n", line);
  fmt::print("\n");
  for (const std::string& line : sectionTable(file).lines()) fmt::print("{}\n", line);
}

Json bakedJson(const FvxFile& file) {
  const fvx::Header& header = file.header();
  Json json{{"format", fmt::format("{}.{}", header.majorVersion, header.minorVersion)},
            {"bytes", header.fileBytes},
            {"bytes_per_active_voxel", bytesPerVoxel(file)},
            {"description", Json::parse(fvx::toJson(file.description()))},
            {"provenance", provenanceJson(file)},
            {"levels", Json::array()},
            {"sections", Json::array()}};
  for (int level = file.levels() - 1; level >= 0; --level)
    for (int channel = 0; channel < fvx::kChannels; ++channel) {
      if (!file.hasChannel(Channel(channel))) continue;
      const LevelSums sums = sumsOf(file.chunks(Channel(channel), level));
      const glm::ivec3 size = file.dimensions(level);
      json["levels"].push_back({{"level", level},
                                {"channel", channelName(Channel(channel))},
                                {"dimensions", {size.x, size.y, size.z}},
                                {"chunks", sums.chunks},
                                {"bricks", sums.bricks},
                                {"active_voxels", sums.activeVoxels},
                                {"stored_bytes", sums.storedBytes},
                                {"unpacked_bytes", sums.bytes}});
    }
  for (const fvx::Section& section : file.sections())
    json["sections"].push_back({{"kind", kindName(section.kind)},
                                {"channel", channelName(section.channel)},
                                {"level", section.level},
                                {"offset", section.offset},
                                {"bytes", section.bytes},
                                {"xxh3_64", fmt::format("{:016x}", section.hash)}});
  return json;
}

}  // namespace freevoxels
