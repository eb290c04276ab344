#include "engine/image/srgb.h"

#include <array>

namespace freevoxels {

namespace {

// Values up to half a byte on the linear part of the curve, 0.5 / 255 / 12.92 = 1.24 / 2^13, map to byte 0.
static_assert(shader::kSrgbFirstBits == std::bit_cast<std::uint32_t>(0x1p-13f));
static_assert(shader::kSrgbEndBits == std::bit_cast<std::uint32_t>(1.0f));
constexpr std::uint32_t kBuckets = (shader::kSrgbEndBits - shader::kSrgbFirstBits) >> shader::kSrgbDroppedBits;

std::uint8_t exactByte(std::uint32_t bits) {
  return byteFromUnit(srgbFromLinear(std::bit_cast<float>(bits)));
}

/// Found by bisection: the bit patterns of positive floats are in the order of the floats.
std::uint32_t firstAbove(std::uint8_t byte, std::uint32_t low, std::uint32_t high) {
  while (low < high) {
    const std::uint32_t middle = low + (high - low) / 2;
    if (exactByte(middle) > byte)
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

/// The sRGB byte of every linear value, exactly as the curve gives it. The values of a bucket share their exponent and the first bits of
/// their mantissa. The curve rises by at most 78 bytes an octave (at 1), so that none of the 128 buckets of an octave contains more than
/// one step from a byte to the next.
std::array<std::uint32_t, kBuckets> makeBuckets() {
  std::array<std::uint32_t, kBuckets> buckets;
  for (std::uint32_t i = 0; i < kBuckets; ++i) {
    const std::uint32_t low = shader::kSrgbFirstBits + (i << shader::kSrgbDroppedBits), high = low + (1u << shader::kSrgbDroppedBits);
    const std::uint8_t byte = exactByte(low);
    buckets[i] = (std::uint32_t(byte) << shader::kSrgbByteShift) + (firstAbove(byte, low, high) - low);
  }
  return buckets;
}

}  // namespace

std::span<const std::uint32_t> srgbBuckets() {
  static const std::array<std::uint32_t, kBuckets> buckets = makeBuckets();
  return buckets;
}

}  // namespace freevoxels
