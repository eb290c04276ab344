#pragma once
// The sums of an image's pixels in 64-bit fixed point. Integers are added exactly, so the sums of any groups of shares, added in any
// order, have the same bits.

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/image/sample_lattice.h"

namespace freevoxels {

/// The sums of a pixel; splat_sums.h defines the quantities. Distance exists only for images with depth.
enum class SumChannel : int { Red = 0, Green = 1, Blue = 2, Energy = 3, OpticalDepth = 4, Distance = 5 };
inline constexpr int kSumChannels = 6;

/// Binary digits behind the point, by channel: an integer i of a channel stands for i / 2^digits.
using SumDigits = std::array<std::int32_t, kSumChannels>;

/// A value that is added to the sums is at most 2^kValueBits - 1 in its channel's unit, so that 256 values,
/// one for each share, stay below 2^63.
inline constexpr int kValueBits = 55;

struct FixedSums {
  glm::ivec2 size{0};                ///< of the image, pixels
  /// Where the frame is gathered: the sums are those of samples of the image instead of pixels.
  std::optional<SampleLattice> lattice = std::nullopt;
  glm::ivec2 first{0}, extent{0};    ///< the rectangle of pixels or samples outside of which all sums are 0
  int channels = kSumChannels;       ///< kSumChannels, or one less without Distance, which a lattice always has
  SumDigits digits{};
  /// How the transmittances were computed, if that depends on a device's memory: sums of different methods
  /// must not be added.
  std::string method;
  std::vector<std::int64_t> values;  ///< [channel][row of the rectangle, from the top][column]

  /// The size of what the rectangle is a part of: the image in pixels, or the lattice in samples.
  glm::ivec2 fullSize() const { return lattice ? lattice->samples : size; }
  std::size_t pixelCount() const { return std::size_t(extent.x) * std::size_t(extent.y); }
  /// The value of pixel `i` of the rectangle.
  double value(SumChannel channel, std::size_t i) const;
  /// Whether the sums of `other` may be added to these: everything except the values is equal.
  bool isLike(const FixedSums& other) const;
  /// Whether adding `other`, which is like these, exceeds the range of 64 bits nowhere.
  bool canAdd(const FixedSums& other) const;
  /// Adds `other`, which must be addable.
  FixedSums& operator+=(const FixedSums& other);
};

/// Resolves the sums to an image, as resolve.comp does, in double precision on the host. Normalised: alpha is
/// 1 - exp(-optical depth) and the colour is C alpha / E; otherwise alpha is E and the colour is C. Samples of a lattice are always
/// normalised, and then interpolated at the pixels. The image has depth if there are distances.
Image resolveSums(const FixedSums& sums, bool normalised);

/// A file of sums: the sums and the header.
struct SumsFile {
  FixedSums sums;
  ExrOptions header;  ///< metadata and matrices
};

/// Writes an OpenEXR file whose data window is the rectangle, with two channels of unsigned 32-bit integers
/// for every 64-bit sum ("red.high", "red.low"), without loss. Atomic. Fails with ErrorKind::Output.
void writeSums(const std::filesystem::path& file, const FixedSums& sums, const ExrOptions& header);

/// Reads such a file. Fails with ErrorKind::Input if it is not one or not complete.
SumsFile readSums(const std::filesystem::path& file);

/// Whether an existing file is an OpenEXR file with channels of sums. Fails with ErrorKind::Input if it cannot
/// be read.
bool holdsSums(const std::filesystem::path& file);

}  // namespace freevoxels
