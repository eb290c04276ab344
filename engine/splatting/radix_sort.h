#pragma once
// Stable radix sort of key-value pairs on the device, from the least significant digit, eight bits a pass.

#include <cstdint>

#include "engine/vulkan/buffer.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

/// The pairs to sort, and temporary memory: 16 bytes a pair.
struct SortPairs {
  Buffer count;                   ///< one uint: number of pairs, at most `capacity`; the device may write it
  Buffer keys, values;            ///< uint; sorted in place
  Buffer spareKeys, spareValues;  ///< uint
  Buffer offsets;                 ///< uint [kSortGroups][kSortDigits]
  std::uint64_t capacity = 0;     ///< largest number of pairs
};

/// Allocates the buffers. A `capacity` of 0 counts as 1.
SortPairs makeSortPairs(const Device& device, std::uint64_t capacity);

/// COMPUTE radix_count.comp, radix_scan.comp, radix_scatter.comp, for each of a key's digits
class RadixSort {
 public:
  explicit RadixSort(const Device& device);
  /// Ascending keys, of which the lower `bits` are looked at; pairs with equal keys keep their order. Count, keys and values must be
  /// visible to compute; leaves them so. `bits` is a multiple of 2 kSortBits.
  void record(Commands& commands, const SortPairs& pairs, int bits = 32) const;

 private:
  Pipeline count_, scan_, scatter_;
};

}  // namespace freevoxels
