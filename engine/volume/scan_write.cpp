#include "engine/volume/scan_write.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

static_assert(std::endian::native == std::endian::little, "the headers say so");

/// A file that is written through zlib, which compresses or not as `mode` says.
class ZlibFile {
 public:
  ZlibFile(const std::filesystem::path& file, const char* mode) : file_(gzopen(file.c_str(), mode)) {
    if (!file_) throw std::runtime_error("it cannot be opened");
  }
  ~ZlibFile() {
    if (file_ != nullptr) gzclose(file_);
  }
  ZlibFile(const ZlibFile&) = delete;
  ZlibFile& operator=(const ZlibFile&) = delete;

  void write(std::span<const std::byte> bytes) {
    if (!bytes.empty() && gzwrite(file_, bytes.data(), unsigned(bytes.size())) <= 0)
      throw std::runtime_error("not all of it could be written");
  }
  void close() {
    if (gzclose(std::exchange(file_, nullptr)) != Z_OK) throw std::runtime_error("not all of it could be written");
  }

 private:
  gzFile file_;
};

void writeVoxels(ZlibFile& file, const Volume& volume, const Progress& progress) {
  const float nothing = volume.isFog || volume.isSolid ? 0.0f : std::numeric_limits<float>::quiet_NaN();
  std::vector<float> row(std::size_t(volume.dimensions.x));
  for (int z = 0; z < volume.dimensions.z; ++z) {
    if (progress) progress("writing the file", double(z) / volume.dimensions.z);
    for (int y = 0; y < volume.dimensions.y; ++y) {
      volume.scalars.copyRow(y, z, row);
      std::ranges::replace(row, kInactiveVoxel, nothing);
      file.write(std::as_bytes(std::span(row)));
    }
  }
}

std::string vectorText(const glm::dvec4& vector) {
  return fmt::format("({},{},{})", vector.x, vector.y, vector.z);
}

template <typename Value>
void place(std::array<std::byte, 352>& header, std::size_t at, Value value) {
  std::memcpy(header.data() + at, &value, sizeof(Value));
}

/// The directions as a quaternion, where they are orthogonal: readers that take the affine map for sheared, as its numbers are small, have
/// these.
void placeQuaternion(std::array<std::byte, 352>& header, const Volume& volume) {
  constexpr double kOrthogonal = 1e-5;
  constexpr std::int16_t kScanner = 1;
  glm::dmat3 directions;
  for (int axis = 0; axis < 3; ++axis)
    directions[axis] = glm::normalize(glm::dvec3(volume.indexToWorld[axis])) * glm::dvec3(-1.0, -1.0, 1.0);
  const double skew = std::abs(glm::dot(directions[0], directions[1])) + std::abs(glm::dot(directions[1], directions[2])) +
                      std::abs(glm::dot(directions[2], directions[0]));
  if (!(skew < kOrthogonal)) return;
  const bool isMirrored = glm::determinant(directions) < 0.0;
  if (isMirrored) directions[2] = -directions[2];
  glm::dquat turn = glm::quat_cast(directions);
  if (turn.w < 0.0) turn = -turn;
  place(header, 76, isMirrored ? -1.0f : 1.0f);
  place(header, 252, kScanner);
  for (const auto& [at, value] : {std::pair(256, turn.x), std::pair(260, turn.y), std::pair(264, turn.z)})
    place(header, std::size_t(at), float(value));
  for (int row = 0; row < 3; ++row) place(header, 268 + 4 * std::size_t(row), float((row < 2 ? -1.0 : 1.0) * volume.indexToWorld[3][row]));
}

/// By https://nifti.nimh.nih.gov/nifti-1: one file, whose affine map is from voxels to RAS millimetres.
std::array<std::byte, 352> niftiHeader(const Volume& volume) {
  std::array<std::byte, 352> header{};
  place(header, 0, std::int32_t(348));
  constexpr std::int16_t kAxes = 3, kOne = 1, kFloat = 16, kBits = 32, kAligned = 2;
  place(header, 40, kAxes);
  for (std::size_t i = 4; i < 8; ++i) place(header, 40 + 2 * i, kOne);
  place(header, 70, kFloat);
  place(header, 72, kBits);
  place(header, 76, 1.0f);
  for (int axis = 0; axis < 3; ++axis) {
    place(header, 42 + 2 * std::size_t(axis), std::int16_t(volume.dimensions[axis]));
    place(header, 80 + 4 * std::size_t(axis), float(glm::length(glm::dvec3(volume.indexToWorld[axis]))));
  }
  place(header, 108, float(header.size()));  // where the values begin
  place(header, 112, 1.0f);                  // slope
  header[123] = std::byte(2);                // millimetres
  place(header, 254, kAligned);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      place(header, 280 + 16 * std::size_t(row) + 4 * std::size_t(column),
            float((row < 2 ? -1.0 : 1.0) * volume.indexToWorld[column][row]));
  placeQuaternion(header, volume);
  std::memcpy(header.data() + 344, "n+1", 4);
  return header;
}

}  // namespace

void writeNrrd(const std::filesystem::path& file, const Volume& volume, const Progress& progress) {
  const glm::ivec3 size = volume.dimensions;
  const std::string header = fmt::format(
      "NRRD0004\n# written by FreeVoxels\ntype: float\ndimension: 3\nspace: left-posterior-superior\nsizes: {} {} {}\n"
      "space directions: {} {} {}\nkinds: domain domain domain\nendian: little\nencoding: gzip\nspace origin: {}\n\n",
      size.x, size.y, size.z, vectorText(volume.indexToWorld[0]), vectorText(volume.indexToWorld[1]), vectorText(volume.indexToWorld[2]),
      vectorText(volume.indexToWorld[3]));
  if (progress) progress("writing the file", 0.0);
  writeAtomically(file, [&](const std::filesystem::path& temporary) {
    std::ofstream start(temporary, std::ios::binary);
    start << header;
    start.close();
    if (!start) throw std::runtime_error("not all of it could be written");
    ZlibFile values(temporary, "ab1");
    writeVoxels(values, volume, progress);
    values.close();
  });
}

void writeNifti(const std::filesystem::path& file, const Volume& volume, const Progress& progress) {
  const glm::ivec3 size = volume.dimensions;
  if (std::max({size.x, size.y, size.z}) > std::numeric_limits<std::int16_t>::max())
    fail(ErrorKind::Input, "'{}' cannot say {} x {} x {} voxels, as NIfTI has up to 32767 along an edge: write .nrrd or .vdb",
         file.string(), size.x, size.y, size.z);
  if (progress) progress("writing the file", 0.0);
  writeAtomically(file, [&](const std::filesystem::path& temporary) {
    ZlibFile values(temporary, file.extension() == ".gz" ? "wb1" : "wbT");
    values.write(niftiHeader(volume));
    writeVoxels(values, volume, progress);
    values.close();
  });
}

}  // namespace freevoxels
