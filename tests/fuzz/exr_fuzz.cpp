#include <ImfThreading.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <random>
#include <string_view>

#include "engine/image/exr_file.h"
#include "engine/image/fixed_sums.h"
#include "engine/image/image.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* bytes, std::size_t size, std::size_t maximum);

namespace {

/// The bytes of the value of the first attribute of this name; empty if there is none.
std::pair<std::size_t, std::size_t> valueOf(std::string_view file, std::string_view name) {
  std::uint32_t size = 0;
  const std::size_t at = file.find(name), type = at == file.npos ? at : file.find('\0', at), value = type == file.npos ? type : file.find('\0', type + 1);
  if (value == file.npos || file.size() - value <= 1 + sizeof(size)) return {0, 0};
  std::memcpy(&size, &file[value + 1], sizeof(size));
  const std::size_t first = value + 1 + sizeof(size);
  return {first, std::min<std::size_t>(size, file.size() - first)};
}

/// Changes what a header says of the size of an image.
void claimAnotherSize(std::uint8_t* bytes, std::size_t size, std::mt19937& random) {
  constexpr std::array<std::string_view, 7> kNames{"dataWindow", "displayWindow", "tiles", "channels", "compression", "type", "freevoxels:lattice"};
  constexpr std::array<std::int32_t, 10> kNumbers{-1, 0, 1, 63, 4095, 16383, 32770, 1 << 20, 1 << 29, std::numeric_limits<int>::max()};
  const auto [first, length] = valueOf({reinterpret_cast<const char*>(bytes), size}, kNames[random() % kNames.size()]);
  const std::int32_t number = kNumbers[random() % kNumbers.size()];
  if (length >= sizeof(number) && random() % 4 != 0)
    std::memcpy(bytes + first + random() % (length / sizeof(number)) * sizeof(number), &number, sizeof(number));
  else if (length > 0)
    bytes[first + random() % length] ^= std::uint8_t(1u << random() % 8);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* bytes, std::size_t size, std::size_t maximum, unsigned seed) {
  std::mt19937 random(seed);
  if (random() % 4 == 0) return LLVMFuzzerMutate(bytes, size, maximum);
  for (auto changes = random() % 4 + 1; changes > 0; --changes) claimAnotherSize(bytes, size, random);
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace freevoxels;
  constexpr std::int64_t kMaxPixels = 1 << 16;
  // Handing such small images to other threads takes longer than reading them, and each has addresses of its own.
  static const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
  useAllProcessors();  // only its first call has an effect
  Imf::setGlobalThreadCount(0);
  const fuzz::FuzzFile file(bytes, size);
  fuzz::tryTo([&] { readExr(file.path(), kMaxPixels); });
  fuzz::tryTo([&] { readHdr(file.path(), kMaxPixels); });
  fuzz::tryTo([&] {
    if (!holdsSums(file.path())) return;
    FixedSums sums = readSums(file.path()).sums;
    const FixedSums same = sums;
    if (sums.canAdd(same)) sums += same;
    const std::int64_t pixels = std::int64_t(sums.size.x) * sums.size.y, samples = std::int64_t(sums.fullSize().x) * sums.fullSize().y;
    if (std::max(pixels, samples) > kMaxPixels) return;
    for (const bool normalised : {false, true}) resolveSums(sums, normalised);
  });
  return 0;
}
