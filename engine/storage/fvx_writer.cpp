#include "engine/storage/fvx_writer.h"

#include <tbb/parallel_for.h>
#include <xxhash.h>

#include <algorithm>
#include <cstring>

#include "engine/core/checked_file.h"
#include "engine/core/error.h"
#include "engine/core/spool.h"
#include "engine/storage/fvx_index.h"
#include "engine/storage/packed_bytes.h"

namespace freevoxels::fvx {

namespace {

std::uint64_t roundUp(std::uint64_t bytes, std::uint64_t alignment) {
  return (bytes + alignment - 1) / alignment * alignment;
}

/// The range of extinctions of the scalars between two scalars.
void setExtinctions(const Classification& classification, ChunkEntry& entry) {
  if (entry.activeVoxels == 0) return;
  const auto extinctionOf = [&](float scalar) { return float(classify(classification, scalar).extinction); };
  const float low = extinctionOf(entry.minimum), high = extinctionOf(entry.maximum);
  entry.leastExtinction = std::min(low, high);
  entry.mostExtinction = std::max(low, high);
  if (!classification.transferFunction) return;
  for (const TransferFunction::OpacityPoint& point : classification.transferFunction->opacity) {
    if (point.scalar < entry.minimum || point.scalar > entry.maximum) continue;
    entry.leastExtinction = std::min(entry.leastExtinction, extinctionOf(point.scalar));
    entry.mostExtinction = std::max(entry.mostExtinction, extinctionOf(point.scalar));
  }
}

std::vector<std::byte> contentBytes(const ContentCells& content) {
  const ContentHeader header{.cells = content.cells.dimensions, .edge = content.edge};
  std::vector<std::byte> bytes(sizeof(header) + (content.cells.values.size() + 7) / 8);
  std::memcpy(bytes.data(), &header, sizeof(header));
  for (std::size_t i = 0; i < content.cells.values.size(); ++i)
    if (content.cells.values[i] != 0) bytes[sizeof(header) + i / 8] |= std::byte(1 << i % 8);
  return bytes;
}

/// The chunks of a channel of a level.
struct ChunkStore {
  std::unique_ptr<Spool> spool;
  std::vector<ChunkEntry> entries;  ///< with offsets in the spool
};

/// Writes sections one after the other, and the header at the end.
class SectionWriter {
 public:
  explicit SectionWriter(const std::filesystem::path& file) : file_(file) { pad(kPageBytes); }

  std::uint64_t next() const { return position_; }

  /// `write` passes the section's bytes to its argument, a piece at a time.
  template <typename Write>
  void section(SectionKind kind, Channel channel, std::size_t level, const Write& write) {
    Section section{.kind = kind, .channel = channel, .level = std::uint32_t(level), .offset = position_};
    const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> hash(XXH3_createState(), XXH3_freeState);
    XXH3_64bits_reset(hash.get());
    write([&](std::span<const std::byte> bytes) {
      XXH3_64bits_update(hash.get(), bytes.data(), bytes.size());
      file_.write(bytes.data(), bytes.size());
      position_ += bytes.size();
    });
    section.bytes = position_ - section.offset;
    section.hash = XXH3_64bits_digest(hash.get());
    header_.sections[header_.sectionCount++] = section;
    pad(roundUp(position_, kPageBytes) - position_);
  }

  void finish() {
    header_.fileBytes = position_;
    header_.hash = XXH3_64bits(&header_, sizeof(header_));
    file_.seek(0);
    file_.write(&header_, sizeof(header_));
    file_.close();
  }

 private:
  void pad(std::uint64_t bytes) {
    const std::vector<std::byte> zeros(bytes);
    file_.write(zeros.data(), zeros.size());
    position_ += bytes;
  }

  CheckedFile file_;
  std::uint64_t position_ = 0;
  Header header_;
};

}  // namespace

struct FvxWriter::State {
  WriteSettings settings;
  std::vector<std::array<ChunkStore, kChannels>> stores;  ///< by level
  ChunkPyramid pyramid{settings.dimensions, settings.withoutData, [this](int level, const ChunkValues& chunk) {
                         for (std::size_t channel = 0; channel < kChannels; ++channel)
                           if (settings.encodings[channel])
                             store(std::size_t(level), channel, encodeChunk(settings, chunk, Channel(channel)));
                       }};

  State(const std::filesystem::path& folder, const WriteSettings& given)
      : settings(given), stores(levelDimensions(given.dimensions).size()) {
    FV_CHECK_LE(stores.size(), std::size_t(kMaxLevels));
    for (auto& level : stores)
      for (std::size_t channel = 0; channel < kChannels; ++channel)
        if (settings.encodings[channel]) level[channel].spool = std::make_unique<Spool>(folder);
  }

  void store(std::size_t level, std::size_t channel, EncodedChunk&& chunk) {
    if (chunk.bytes.empty()) return;
    ChunkStore& to = stores[level][channel];
    chunk.entry.offset = to.spool->bytes();
    to.entries.push_back(chunk.entry);
    chunk.bytes.resize(roundUp(chunk.bytes.size(), kChunkAlignment));
    to.spool->append(chunk.bytes);
  }

  void writeChunks(SectionWriter& file, std::size_t level, std::size_t channel, const Classification& classification) {
    ChunkStore& from = stores[level][channel];
    const std::uint64_t indexBytes = from.entries.size() * sizeof(ChunkEntry);
    const std::uint64_t first = file.next() + roundUp(indexBytes, kPageBytes);
    for (ChunkEntry& entry : from.entries) {
      entry.offset += first;
      if (Channel(channel) == Channel::Scalars) setExtinctions(classification, entry);
    }
    file.section(SectionKind::ChunkIndex, Channel(channel), level,
                 [&](const auto& take) { take(std::as_bytes(std::span(from.entries))); });
    file.section(SectionKind::Chunks, Channel(channel), level, [&](const auto& take) { from.spool->readAll(take); });
  }
};

FvxWriter::FvxWriter(const std::filesystem::path& folder, const WriteSettings& settings)
    : state_(std::make_unique<State>(folder, settings)) {}

FvxWriter::~FvxWriter() = default;

void FvxWriter::add(std::span<const std::byte> encoded) {
  State& state = *state_;
  for (ByteUnpacker bytes(encoded); !bytes.atEnd();) {
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      if (!state.settings.encodings[channel]) continue;
      EncodedChunk chunk;
      bytes.value(chunk.entry);
      bytes.values(chunk.bytes);
      state.store(0, channel, std::move(chunk));
    }
    ChunkEighth eighth;
    bytes.value(eighth.cell);
    for (std::vector<float>& values : eighth.channels) bytes.values(values);
    state.pyramid.add(eighth);
  }
}

FvxWriter::Summary FvxWriter::summary(Channel channel) const {
  Summary sum;
  for (const ChunkEntry& entry : state_->stores.front()[std::size_t(channel)].entries) {
    if (entry.activeVoxels == 0) continue;
    sum.minimum = sum.activeVoxels == 0 ? entry.minimum : std::min(sum.minimum, entry.minimum);
    sum.maximum = sum.activeVoxels == 0 ? entry.maximum : std::max(sum.maximum, entry.maximum);
    sum.activeVoxels += entry.activeVoxels;
  }
  return sum;
}

void FvxWriter::finish(const std::filesystem::path& file, const Description& description, const ContentCells& content,
                       const std::string& provenance) {
  State& state = *state_;
  state.pyramid.finish();
  SectionWriter writer(file);
  const auto text = [&](SectionKind kind, const std::string& json) {
    writer.section(kind, Channel(), 0, [&](const auto& take) { take(std::as_bytes(std::span(json))); });
  };
  text(SectionKind::Description, toJson(description));
  text(SectionKind::Provenance, provenance);
  writer.section(SectionKind::ContentCells, Channel(), 0, [&](const auto& take) { take(contentBytes(content)); });
  for (std::size_t level = state.stores.size(); level-- > 0;)
    for (std::size_t channel = 0; channel < kChannels; ++channel)
      if (state.settings.encodings[channel]) state.writeChunks(writer, level, channel, *description.volume.classification);
  writer.finish();
}

}  // namespace freevoxels::fvx
