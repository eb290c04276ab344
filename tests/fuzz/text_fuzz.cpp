// Descriptions in TIFF, and names and options that say what a file without a header is.
#include "engine/description/text_values.h"
#include "engine/volume/raw_layout.h"
#include "engine/volume/tiff_description.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace freevoxels;
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  const auto planesOf = [](const std::optional<TiffDescription>& description) {
    if (description &&
        description->planeAt(description->channels - 1, description->slices - 1, description->frames - 1) + 1 != description->planes())
      std::abort();
  };
  fuzz::tryTo([&] { planesOf(imageJDescription("a.tif", text)); });
  fuzz::tryTo([&] { planesOf(omeDescription("a.tif", text, 1)); });
  fuzz::tryTo([&] { layoutOfName(text); });
  fuzz::tryTo([&] {
    const RawLayout layout = readRawLayout("raw", text);
    if (readRawLayout("raw", rawLayoutText(layout)) != layout) std::abort();
  });
  fuzz::tryTo([&] {
    const SlicePlane plane = readSlicePlane("slice", text);
    if (readSlicePlane("slice", slicePlaneText(plane)) != plane) std::abort();
  });
  return 0;
}
