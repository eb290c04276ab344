#include "engine/splatting/radix_sort.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "embedded/radix_count.h"
#include "embedded/radix_scan.h"
#include "embedded/radix_scatter.h"
#include "engine/core/error.h"
#include "shaders/interface.h"

namespace freevoxels {

namespace {

constexpr int kThreads = shader::kSortGroups * shader::kSortThreads;

}  // namespace

SortPairs makeSortPairs(const Device& device, std::uint64_t capacity) {
  SortPairs pairs;
  pairs.capacity = std::max<std::uint64_t>(capacity, 1);
  const auto uints = [&](std::uint64_t count, const char* name) {
    return Buffer(device, count * sizeof(std::uint32_t), MemoryUse::Device, name);
  };
  pairs.count = uints(1, "pair count");
  pairs.keys = uints(pairs.capacity, "sort keys");
  pairs.values = uints(pairs.capacity, "sort values");
  pairs.spareKeys = uints(pairs.capacity, "spare sort keys");
  pairs.spareValues = uints(pairs.capacity, "spare sort values");
  pairs.offsets = uints(std::uint64_t(shader::kSortGroups) * shader::kSortDigits, "sort offsets");
  return pairs;
}

RadixSort::RadixSort(const Device& device)
    : count_(makeComputePipeline(device, shaders::radix_count)),
      scan_(makeComputePipeline(device, shaders::radix_scan)),
      scatter_(makeComputePipeline(device, shaders::radix_scatter)) {}

void RadixSort::record(Commands& commands, const SortPairs& pairs, int bits) const {
  FV_CHECK_EQ(bits % (2 * shader::kSortBits), 0);  // the last pass must end in SortPairs::keys and values
  const Buffer *keys = &pairs.keys, *values = &pairs.values;
  const Buffer *sortedKeys = &pairs.spareKeys, *sortedValues = &pairs.spareValues;
  for (std::uint32_t shift = 0; shift < std::uint32_t(bits); shift += shader::kSortBits) {
    const shader::RadixPush push{shift};
    const std::array<Binding, 3> count{&pairs.count, keys, &pairs.offsets};
    const std::array<Binding, 1> scan{&pairs.offsets};
    const std::array<Binding, 6> scatter{&pairs.count,   keys,       values,
                                         &pairs.offsets, sortedKeys, sortedValues};
    commands.dispatch(count_, count, push, {kThreads, 1, 1});
    commands.barrier(kComputeStage, kComputeStage);
    commands.dispatch(scan_, scan, {shader::kSortThreads, 1, 1});
    commands.barrier(kComputeStage, kComputeStage);
    commands.dispatch(scatter_, scatter, push, {kThreads, 1, 1});
    commands.barrier(kComputeStage, kComputeStage);
    std::swap(keys, sortedKeys);
    std::swap(values, sortedValues);
  }
}

}  // namespace freevoxels
