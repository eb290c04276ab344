#include "engine/image/image.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace freevoxels;
  // Large images that a file of this size may hold, a bit for each pixel, are slow, not wrong; larger ones must be refused at once.
  constexpr std::size_t kHeader = 24;
  constexpr std::uint64_t kSlow = 1 << 20, kMaxShrinking = 1100 * 8;
  const auto number = [&](std::size_t at) { return std::uint64_t(bytes[at]) << 24 | bytes[at + 1] << 16 | bytes[at + 2] << 8 | bytes[at + 3]; };
  if (size >= kHeader && number(16) * number(20) > kSlow && number(16) * number(20) <= kMaxShrinking * size) return -1;
  const fuzz::FuzzFile file(bytes, size);
  fuzz::tryTo([&] { readPng(file.path()); });
  return 0;
}
