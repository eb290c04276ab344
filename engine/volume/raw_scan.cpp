#include <algorithm>
#include <bit>
#include <system_error>
#include <vector>

#include "engine/core/random_access_file.h"
#include "engine/volume/scan_reader.h"

namespace freevoxels {

namespace {

class RawScan : public ScanReader {
 public:
  RawScan(const std::filesystem::path& file, const RawLayout& layout) : path_(file), file_(file), layout_(layout) {
    header_ = {.format = "raw", .dimensions = layout.dimensions, .type = layout.type};
    const std::uint64_t needed = layout.headerBytes + header_.samples() * bytesOf(layout.type);
    if (file_.bytes() != needed)
      fail(ErrorKind::Input, "'{}' has {} bytes, and {} takes {}: correct the layout", file.string(), file_.bytes(),
           Parameter("raw", rawLayoutText(layout)), needed);
  }

  void read(const ScanPart&, const SampleSink& sink, const Progress& progress) override {
    const glm::ivec3 size = layout_.dimensions;
    const std::uint64_t slice = bytesOfSlice();
    const int slices = slicesAtOnce();
    std::vector<std::byte> buffer(slice * std::uint64_t(slices));
    for (int z = 0; z < size.z; z += slices) {
      if (progress) progress("reading the scan", double(z) / size.z);
      const int count = std::min(slices, size.z - z);
      const std::span<std::byte> part(buffer.data(), slice * std::uint64_t(count));
      if (file_.readAt(layout_.headerBytes + slice * std::uint64_t(z), part) != part.size()) failDamaged(path_, "it ends too early");
      sink({.samples = buffer.data(),
            .type = layout_.type,
            .isSwapped = layout_.isBigEndian != (std::endian::native == std::endian::big),
            .first = {0, 0, z},
            .extent = {size.x, size.y, count}});
    }
  }

  std::uint64_t bytesToRead() const override { return bytesOfSlice() * std::uint64_t(slicesAtOnce()); }

 private:
  std::uint64_t bytesOfSlice() const {
    return std::uint64_t(layout_.dimensions.x) * std::uint64_t(layout_.dimensions.y) * bytesOf(layout_.type);
  }
  int slicesAtOnce() const {
    constexpr std::uint64_t kBytes = std::uint64_t(64) << 20;
    return int(std::clamp<std::uint64_t>(kBytes / bytesOfSlice(), 1, std::uint64_t(layout_.dimensions.z)));
  }

  const std::filesystem::path path_;
  const RandomAccessFile file_;
  const RawLayout layout_;
};

}  // namespace

std::unique_ptr<ScanReader> openRawScan(const std::filesystem::path& file, const RawLayout& layout) {
  return std::make_unique<RawScan>(file, layout);
}

}  // namespace freevoxels
