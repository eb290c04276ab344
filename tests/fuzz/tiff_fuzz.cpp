#include "tests/fuzz/fuzz_scan.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace freevoxels;
  const fuzz::FuzzFile file(bytes, size);
  fuzz::tryTo([&] { fuzz::readScanOf(*openTiffScan(file.path())); });
  return 0;
}
