#include "engine/image/image.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace freevoxels;
  // The size that the header claims, which readPng allocates: large images are slow, not wrong.
  constexpr std::size_t kHeader = 24;
  if (size >= kHeader && (bytes[16] | bytes[17] | bytes[20] | bytes[21]) != 0) return -1;
  const fuzz::FuzzFile file(bytes, size);
  fuzz::tryTo([&] { readPng(file.path()); });
  return 0;
}
