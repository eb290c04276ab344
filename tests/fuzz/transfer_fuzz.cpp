#include <optional>
#include <string>

#include "engine/volume/transfer_formats.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace freevoxels;
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  for (const char* wanted : {"", "A"}) {
    std::optional<TransferCurves> curves;
    fuzz::tryTo([&] { curves = readTransferText({.name = "fuzz", .text = text, .wanted = wanted}); });
    if (!curves) continue;
    // What was understood is a function that the programs take, with points in order.
    const TransferCurves again = parseTransferCurves("written", transferCurvesJson(*curves));
    if (again.opacity.size() != curves->opacity.size() || again.color.size() != curves->color.size()) std::abort();
  }
  return 0;
}
