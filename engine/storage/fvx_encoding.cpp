#include "engine/storage/fvx_encoding.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "engine/core/error.h"
#include "engine/volume/scalar_bricks.h"

namespace freevoxels::fvx {

namespace {

constexpr std::uint16_t kNoHalf = 0xffff, kNoCode = 0;
constexpr double kMaxHalf = 65504.0, kMaxCode = 65535.0;
constexpr std::uint32_t kExponent = 0x7f800000;  ///< bits of a float, all of them 1 in NaN and infinities
/// Of a decoded value: between the numbers of floats, and not kInactiveVoxel.
const double kMaxValue = std::nextafter(std::numeric_limits<float>::max(), 0.0f);

std::uint16_t halfOf(double value, double scale) {
  return glm::packHalf1x16(float(std::clamp(value / scale, -kMaxHalf, kMaxHalf)));
}

std::uint16_t codeOf(double value, const Encoding& encoding) {
  if (!(encoding.scale > 0.0)) return 1;
  return std::uint16_t(std::clamp((value - encoding.offset) / encoding.scale + 1.5, 1.0, kMaxCode));
}

/// Values beyond it become the nearest one in it.
std::pair<double, double> rangeOf(const Encoding& encoding) {
  if (encoding.kind == EncodingKind::Float16) return {-kMaxHalf * encoding.scale, kMaxHalf * encoding.scale};
  if (encoding.kind == EncodingKind::Linear16) return {encoding.offset, encoding.offset + (kMaxCode - 1.0) * encoding.scale};
  return {std::numeric_limits<float>::lowest(), std::numeric_limits<float>::max()};
}

/// Bound of how far a value within the encoding's range is from what it was before it was encoded.
double largestError(const Encoding& encoding, double value) {
  constexpr double kHalfError = 0x1p-10, kMinHalf = 0x1p-24,
                   kFloatError = 0x1p-22;  // relative error of halves, the least of them, that of floats
  constexpr double kMinFloat = std::numeric_limits<float>::denorm_min();
  if (encoding.kind == EncodingKind::Float32) return 0.0;
  if (encoding.kind == EncodingKind::Float16) return std::max({std::abs(value) * kHalfError, encoding.scale * kMinHalf, kMinFloat});
  return encoding.scale + std::max(std::abs(value) * kFloatError, kMinFloat);
}

}  // namespace

std::pair<float, float> Encoding::decodedRange(float minimum, float maximum) const {
  const auto [low, high] = rangeOf(*this);
  const double least = std::clamp(double(minimum), low, high), most = std::clamp(double(maximum), low, high);
  constexpr double kMost = std::numeric_limits<float>::max();
  return {float(std::max(least - largestError(*this, least), -kMost)), float(std::min(most + largestError(*this, most), kMost))};
}

void encode(const Encoding& encoding, std::span<const float> values, std::span<std::byte> bytes) {
  FV_CHECK_EQ(bytes.size(), values.size() * encoding.bytesPerValue());
  if (encoding.kind == EncodingKind::Float32) {
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return;
  }
  const bool halves = encoding.kind == EncodingKind::Float16;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::uint16_t code = halves ? kNoHalf : kNoCode;
    if (values[i] != kInactiveVoxel) code = halves ? halfOf(values[i], encoding.scale) : codeOf(values[i], encoding);
    std::memcpy(&bytes[2 * i], &code, sizeof(code));
  }
}

bool areFinite(std::span<const float> values) {
  std::size_t others = 0;
  for (const float value : values) others += (std::bit_cast<std::uint32_t>(value) & kExponent) == kExponent;
  return others == 0;
}

Decoder::Decoder(const Encoding& encoding) {
  if (encoding.kind == EncodingKind::Float32) return;
  const bool halves = encoding.kind == EncodingKind::Float16;
  values_.resize(1 << 16);
  for (std::size_t code = 0; code < values_.size(); ++code) {
    const float half = halves ? glm::unpackHalf1x16(std::uint16_t(code)) : 0.0f;
    const double value = halves ? double(half) * encoding.scale : encoding.offset + (double(code) - 1.0) * encoding.scale;
    values_[code] = std::isfinite(half) ? float(std::clamp(value, -kMaxValue, kMaxValue)) : std::numeric_limits<float>::quiet_NaN();
  }
  values_[halves ? kNoHalf : kNoCode] = kInactiveVoxel;
}

bool Decoder::decode(std::span<const std::byte> bytes, std::span<float> values) const {
  FV_CHECK_EQ(bytes.size(), values.size() * (values_.empty() ? 4 : 2));
  if (values_.empty()) {
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return areFinite(values);
  }
  bool finite = true;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::uint16_t code;
    std::memcpy(&code, &bytes[2 * i], sizeof(code));
    values[i] = values_[code];
    finite &= values[i] == values[i];
  }
  return finite;
}

}  // namespace freevoxels::fvx
