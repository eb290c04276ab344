#include <ImfThreading.h>

#include "engine/image/image.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace freevoxels;
  constexpr std::int64_t kMaxPixels = 1 << 16;
  Imf::setGlobalThreadCount(0);  // handing such small images to other threads takes longer than reading them
  const fuzz::FuzzFile file(bytes, size);
  fuzz::tryTo([&] { readExr(file.path(), kMaxPixels); });
  return 0;
}
