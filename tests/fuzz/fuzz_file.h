#pragma once
// The bytes of one execution as a file, for readers that take a path.

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>

#include "engine/core/error.h"

namespace freevoxels::fuzz {

/// Lies in memory.
class FuzzFile {
 public:
  FuzzFile(const std::uint8_t* bytes, std::size_t size) : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) {
    if (descriptor_ < 0 || write(descriptor_, bytes, size) != ssize_t(size)) std::abort();
  }
  ~FuzzFile() { close(descriptor_); }
  FuzzFile(const FuzzFile&) = delete;
  FuzzFile& operator=(const FuzzFile&) = delete;

  std::filesystem::path path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

 private:
  int descriptor_;
};

/// Calls `read`. Refusing the file is as good as reading it; any other exception ends the fuzzer.
template <typename Read>
void tryTo(const Read& read) {
  try {
    read();
  } catch (const Error&) {
  }
}

}  // namespace freevoxels::fuzz
