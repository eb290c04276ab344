#include <ImfThreading.h>

#include "engine/image/fixed_sums.h"
#include "engine/image/image.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace freevoxels;
  constexpr std::int64_t kMaxPixels = 1 << 16;
  Imf::setGlobalThreadCount(0);  // handing such small images to other threads takes longer than reading them
  const fuzz::FuzzFile file(bytes, size);
  fuzz::tryTo([&] { readExr(file.path(), kMaxPixels); });
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
