#include "engine/volume/nifti_values.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "engine/volume/scan_reader.h"

namespace freevoxels {

namespace {

constexpr std::int32_t kHeaderBytes = 348;

struct Close {
  void operator()(gzFile_s* file) const { gzclose(file); }
};

std::uint64_t bytesOfSlice(const ScanHeader& header) {
  return std::uint64_t(header.dimensions.x) * std::uint64_t(header.dimensions.y) * header.bytesOfVoxel();
}

int slicesAtOnce(const ScanHeader& header) {
  constexpr std::uint64_t kBytes = std::uint64_t(16) << 20;
  return int(std::clamp<std::uint64_t>(kBytes / bytesOfSlice(header), 1, std::uint64_t(header.dimensions.z)));
}

/// A number of the header, whose bytes may be in the other order.
template <typename Value>
Value valueAt(const std::array<char, kHeaderBytes>& header, std::size_t place, bool isSwapped) {
  char bytes[sizeof(Value)];
  std::copy_n(header.begin() + std::ptrdiff_t(place), sizeof(Value), bytes);
  if (isSwapped) std::reverse(bytes, bytes + sizeof(Value));
  Value value;
  std::memcpy(&value, bytes, sizeof(Value));
  return value;
}

}  // namespace

void readNiftiValues(const std::filesystem::path& file, const ScanHeader& header, int timeStep, const SampleSink& sink,
                     const Progress& progress) {
  constexpr std::size_t kOffsetPlace = 108;
  const std::unique_ptr<gzFile_s, Close> stream(gzopen(file.c_str(), "rb"));
  if (!stream) failDamaged(file, "it cannot be opened");
  const auto mustRead = [&](void* bytes, std::size_t count) {
    for (std::size_t done = 0; done < count;) {
      const auto part = unsigned(std::min<std::size_t>(count - done, std::numeric_limits<int>::max()));
      const int got = gzread(stream.get(), static_cast<char*>(bytes) + done, part);
      if (got <= 0) failDamaged(file, "its values end too early");
      done += std::size_t(got);
    }
  };
  std::array<char, kHeaderBytes> start{};
  mustRead(start.data(), start.size());
  const bool isSwapped = valueAt<std::int32_t>(start, 0, false) != kHeaderBytes;
  const float offset = valueAt<float>(start, kOffsetPlace, isSwapped);
  if (valueAt<std::int32_t>(start, 0, isSwapped) != kHeaderBytes || !(offset >= float(kHeaderBytes)) || offset > 1e9f)
    failDamaged(file, "its header is damaged, or not that of NIfTI-1 in one file");
  const std::uint64_t slice = bytesOfSlice(header);
  const std::uint64_t first = std::uint64_t(offset) + slice * std::uint64_t(header.dimensions.z) * std::uint64_t(timeStep);
  if (gzseek(stream.get(), z_off_t(first), SEEK_SET) != z_off_t(first)) failDamaged(file, "its values end too early");

  const int slices = slicesAtOnce(header);
  std::vector<std::byte> buffer(slice * std::uint64_t(slices));
  for (int z = 0; z < header.dimensions.z; z += slices) {
    if (progress) progress("reading the scan", double(z) / header.dimensions.z);
    const int count = std::min(slices, header.dimensions.z - z);
    mustRead(buffer.data(), slice * std::uint64_t(count));
    const glm::dvec2 rescale = header.rescale.value_or(glm::dvec2(1.0, 0.0));
    sink({.samples = buffer.data(),
          .type = header.type,
          .components = header.components,
          .isSwapped = isSwapped,
          .slope = rescale.x,
          .intercept = rescale.y,
          .first = {0, 0, z},
          .extent = {header.dimensions.x, header.dimensions.y, count}});
  }
  if (timeStep + 1 < header.timeSteps) return;
  char beyond = 0;
  int problem = Z_OK;
  gzread(stream.get(), &beyond, 1);
  gzerror(stream.get(), &problem);
  if (problem == Z_BUF_ERROR || problem == Z_DATA_ERROR) failDamaged(file, "its checksum is wrong, or missing");
}

std::uint64_t bytesToReadNifti(const ScanHeader& header) {
  return bytesOfSlice(header) * std::uint64_t(slicesAtOnce(header));
}

}  // namespace freevoxels
