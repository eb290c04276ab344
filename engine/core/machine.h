#pragma once
// The machine that the program runs on.

#include <unistd.h>

#include <cstdint>

namespace freevoxels {

/// Bytes of its main memory.
inline std::uint64_t machineMemoryBytes() {
  return std::uint64_t(sysconf(_SC_PHYS_PAGES)) * std::uint64_t(sysconf(_SC_PAGESIZE));
}

}  // namespace freevoxels
