#pragma once
// How the values of a channel of a baked volume are stored.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace freevoxels::fvx {

enum class EncodingKind {
  Float32,   ///< the value itself, kInactiveVoxel included
  Float16,   ///< half float h: the value is h * scale; 0xffff is a voxel without data
  Linear16,  ///< integer c: the value is offset + (c - 1) * scale; 0 is a voxel without data
};

/// The names in the file, in the order of EncodingKind.
inline constexpr std::string_view kEncodingNames[]{"float32", "float16", "linear16"};

struct Encoding {
  EncodingKind kind = EncodingKind::Float32;
  double scale = 1.0, offset = 0.0;

  std::size_t bytesPerValue() const { return kind == EncodingKind::Float32 ? 4 : 2; }
  /// The range of what values between two are after they were encoded, rounded up or down, and decoded.
  std::pair<float, float> decodedRange(float minimum, float maximum) const;
};

/// Encodes values; those beyond the encoding's range become the nearest one in it. `bytes` has
/// bytesPerValue() for each value.
void encode(const Encoding& encoding, std::span<const float> values, std::span<std::byte> bytes);

/// Whether no value is NaN or infinite.
bool areFinite(std::span<const float> values);

class Decoder {
 public:
  explicit Decoder(const Encoding& encoding);
  /// Returns false if any value is NaN or infinite, which encode() stores of none.
  [[nodiscard]] bool decode(std::span<const std::byte> bytes, std::span<float> values) const;

 private:
  std::vector<float> values_;  ///< value of each 16-bit code, NaN of those that encode() makes of none; empty for Float32
};

}  // namespace freevoxels::fvx
