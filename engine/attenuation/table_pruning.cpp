#include "engine/attenuation/table_pruning.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "embedded/prune_compact.h"
#include "embedded/prune_mark.h"
#include "engine/core/error.h"
#include "shaders/interface.h"

namespace freevoxels {

namespace {

constexpr std::uint64_t kRunBytes = shader::kRunBlocks;

shader::RunsPush runsPush(const AttenuationTable& table) {
  return {.runCount = std::uint32_t(table.planes.front().bytes() / kRunBytes),
          .cellCount = std::uint32_t(cellCount(table.settings.directions)),
          .maxCodePerDirection = table.settings.code == AttenuationCode::Linear8 ? 0 : 0xffffffffu};
}

std::vector<shader::OccupancyWord> downloadWords(const Device& device, const Buffer& buffer) {
  std::vector<shader::OccupancyWord> words(buffer.bytes() / sizeof(shader::OccupancyWord));
  download(device, buffer, std::as_writable_bytes(std::span(words)));
  return words;
}

/// Writes into each word how many kept runs precede it, and returns their total. The first kept run is the
/// one that stands for all removed runs.
std::uint32_t countKept(std::vector<shader::OccupancyWord>& words) {
  std::uint32_t kept = 1;
  for (shader::OccupancyWord& word : words) {
    word.before = kept;
    kept += std::uint32_t(std::popcount(word.mask));
  }
  return kept;
}

/// Whether there may be voxels that store the maxCodePerDirection code in every direction.
bool endsInAllDirections(const Device& device, const AttenuationTable& table) {
  const AttenuationCode code = table.settings.code;
  const double end = decodeOpticalDepth(code, code == AttenuationCode::Linear8 ? 0 : 255);
  return std::ranges::min(downloadLargestDepths(device, table)) >= end;
}

/// The occupancy words of the runs to keep; the number of kept runs before each word is not filled in yet.
Buffer findSeen(const Device& device, const AttenuationTable& table, std::vector<StageTime>& times) {
  const shader::RunsPush push = runsPush(table);
  const std::uint64_t groups = (push.runCount + shader::kRunThreads - 1) / shader::kRunThreads;
  Buffer words(device,
               groups * (shader::kRunThreads / shader::kBlocksPerWord) * sizeof(shader::OccupancyWord),
               MemoryUse::Device, "seen runs");
  const Pipeline pass = makeComputePipeline(device, shaders::prune_mark);
  const std::array<Binding, 2> bindings{&table.planeAddresses, &words};
  Commands commands(device);
  commands.beginPass("unseen runs");
  commands.dispatchLinear(pass, bindings, push, push.runCount);
  commands.submitAndWait();
  addTimes(times, commands.times());
  return words;
}

}  // namespace

void pruneOpaqueRuns(const Device& device, AttenuationTable& table, std::vector<StageTime>& times) {
  FV_CHECK_EQ(table.keptRuns.bytes(), 0u);
  if (!endsInAllDirections(device, table)) return;
  const shader::RunsPush push = runsPush(table);
  Buffer seen = findSeen(device, table, times);
  std::vector<shader::OccupancyWord> words = downloadWords(device, seen);
  const std::uint64_t bytes = countKept(words) * kRunBytes;
  if (bytes > table.planes.front().bytes() / 4 * 3 || bytes > device.availableBytes()) return;
  upload(device, seen, std::as_bytes(std::span(words)));
  table.planeTexels.clear();
  const Pipeline pass = makeComputePipeline(device, shaders::prune_compact);
  for (Buffer& plane : table.planes) {
    Buffer kept(device, bytes, MemoryUse::Device, "attenuation of what is seen");
    const std::array<Binding, 3> bindings{&seen, &plane, &kept};
    Commands commands(device);
    commands.beginPass("unseen runs");
    commands.dispatchLinear(pass, bindings, push, push.runCount);
    commands.submitAndWait();
    addTimes(times, commands.times());
    plane = std::move(kept);
  }
  table.keptRuns = std::move(seen);
  table.uploadAddresses(device);
}

SeenRuns downloadSeenRuns(const Device& device, const AttenuationTable& table) {
  SeenRuns runs;
  if (table.keptRuns.bytes() == 0) return runs;
  for (const shader::OccupancyWord& word : downloadWords(device, table.keptRuns)) {
    std::uint64_t next = word.before;
    for (int bit = 0; bit < shader::kBlocksPerWord; ++bit)
      runs.push_back((word.mask >> bit & 1u) != 0 ? kRunBytes * next++ : 0);
  }
  return runs;
}

std::vector<std::uint8_t> downloadCodes(const Device& device, const Buffer& plane, const SeenRuns& runs,
                                        std::uint64_t first, std::uint64_t count) {
  if (runs.empty()) {
    std::vector<std::uint8_t> codes(count);
    download(device, plane, std::as_writable_bytes(std::span(codes)), first);
    return codes;
  }
  std::vector<std::uint8_t> kept(plane.bytes());
  download(device, plane, std::as_writable_bytes(std::span(kept)));
  std::vector<std::uint8_t> codes;
  codes.reserve(count);
  for (std::uint64_t rank = first; rank < first + count; ++rank)
    codes.push_back(kept[runs[rank / kRunBytes] + rank % kRunBytes]);
  return codes;
}

}  // namespace freevoxels
