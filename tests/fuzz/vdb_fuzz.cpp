#include "engine/volume/vdb.h"
#include "tests/fuzz/fuzz_file.h"

/// For the leak sanitizer: OpenVDB drops the nodes that it was reading when it throws.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:readTopology\nleak:readBuffers\n";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace freevoxels;
  constexpr std::uint64_t kMaxVoxels = 1 << 20;
  const fuzz::FuzzFile file(bytes, size);
  fuzz::tryTo([&] { describeVdb(file.path()); });
  fuzz::tryTo([&] { listVdb(file.path()); });
  fuzz::tryTo([&] { readVdb(file.path(), "", kMaxVoxels, {.temperature = GridRequest{.name = "", .isRequired = true}}); });
  fuzz::tryTo([&] { readVdb(file.path(), "", kMaxVoxels); });
  return 0;
}
