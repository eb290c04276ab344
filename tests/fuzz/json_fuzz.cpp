#include "engine/volume/classification.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace freevoxels;
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  Volume volume;
  volume.minimum = 0.0f;
  volume.maximum = 2.0f;
  fuzz::tryTo([&] { transferFunctionJson(parseTransferFunction(text, volume)); });
  return 0;
}
