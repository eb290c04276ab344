#include "engine/image/srgb.h"

#include <array>
#include <bit>

namespace freevoxels {

namespace {

/// A table of the sRGB byte of every linear value, exactly as the curve gives it. The values of a bucket
/// share their exponent and the first bits of their mantissa. The curve rises by at most 78 bytes an octave
/// (at 1), so that none of the 128 buckets of an octave contains more than one step from a byte to the next.
class SrgbByteTable {
 public:
  SrgbByteTable() {
    for (std::uint32_t i = 0; i < kBuckets; ++i) {
      const std::uint32_t low = kFirst + (i << kDropped), high = low + (1u << kDropped);
      const std::uint8_t byte = exactByte(low);
      buckets_[i] = {std::bit_cast<float>(firstAbove(byte, low, high)), byte};
    }
  }

  std::span<const shader::SrgbBucket> buckets() const { return buckets_; }

 private:
  static constexpr std::uint32_t kDropped = shader::kSrgbDroppedBits;  ///< low bits of the mantissa that do not select a bucket
  /// Values up to half a byte on the linear part of the curve, 0.5 / 255 / 12.92 = 1.24 / 2^13, map to byte
  /// 0.
  static constexpr std::uint32_t kFirst = std::bit_cast<std::uint32_t>(0x1p-13f);
  static constexpr std::uint32_t kEnd = std::bit_cast<std::uint32_t>(1.0f);
  static_assert(kFirst == shader::kSrgbFirstBits && kEnd == shader::kSrgbEndBits);
  static constexpr std::uint32_t kBuckets = (kEnd - kFirst) >> kDropped;

  static std::uint8_t exactByte(std::uint32_t bits) {
    return byteFromUnit(srgbFromLinear(std::bit_cast<float>(bits)));
  }

  /// Found by bisection: the bit patterns of positive floats are in the order of the floats.
  static std::uint32_t firstAbove(std::uint8_t byte, std::uint32_t low, std::uint32_t high) {
    while (low < high) {
      const std::uint32_t middle = low + (high - low) / 2;
      if (exactByte(middle) > byte)
        high = middle;
      else
        low = middle + 1;
    }
    return low;
  }

  std::array<shader::SrgbBucket, kBuckets> buckets_;
};

}  // namespace

std::span<const shader::SrgbBucket> srgbBuckets() {
  static const SrgbByteTable table;
  return table.buckets();
}

}  // namespace freevoxels
