#pragma once
// Scans that are small enough are read as a whole.

#include "engine/volume/scan_reader.h"
#include "tests/fuzz/fuzz_file.h"

namespace freevoxels::fuzz {

inline void readScanOf(ScanReader& reader) {
  constexpr std::uint64_t kMostVoxels = 1 << 18, kMaxBytes = std::uint64_t(1) << 28;
  const ScanHeader& header = reader.header();
  if (header.samples() > kMostVoxels || reader.bytesToRead() > kMaxBytes) return;
  ScanVoxels voxels(reader.fillsBox() ? header.type : SampleType::F32, header.dimensions);
  const int channels = std::max(int(header.channels.size()), 1);
  reader.read({.timeStep = header.timeSteps - 1, .channel = channels - 1},
              [&](const SampleBlock& block) { voxels.put(block, block.components - 1); }, {});
}

}  // namespace freevoxels::fuzz
