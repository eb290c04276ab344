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
constexpr double kLargestHalf = 65504.0, kLargestCode = 65535.0;
constexpr std::uint32_t kExponent = 0x7f800000;  ///< bits of a float, all of them 1 in NaN and infinities
/// Of a decoded value: between the numbers of floats, and not kInactiveVoxel.
const double kLargestValue = std::nextafter(std::numeric_limits<float>::max(), 0.0f);

std::uint16_t halfOf(double value, double scale) {
  return glm::packHalf1x16(float(std::clamp(value / scale, -kLargestHalf, kLargestHalf)));
}

std::uint16_t codeOf(double value, const Encoding& encoding) {
  if (!(encoding.scale > 0.0)) return 1;
  return std::uint16_t(std::clamp((value - encoding.offset) / encoding.scale + 1.5, 1.0, kLargestCode));
}

}  // namespace

double Encoding::largestError(double value) const {
  constexpr double kHalf = 0x1p-10, kLeastHalf = 0x1p-24, kFloat = 0x1p-22;  // relative error of halves, the least of them, that of floats
  if (kind == EncodingKind::Float32) return 0.0;
  if (kind == EncodingKind::Float16) return std::max(std::abs(value) * kHalf, scale * kLeastHalf);
  return scale + std::abs(value) * kFloat;
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
  bool finite = true;
  for (const float value : values) finite &= (std::bit_cast<std::uint32_t>(value) & kExponent) != kExponent;
  return finite;
}

Decoder::Decoder(const Encoding& encoding) {
  if (encoding.kind == EncodingKind::Float32) return;
  const bool halves = encoding.kind == EncodingKind::Float16;
  values_.resize(1 << 16);
  for (std::size_t code = 0; code < values_.size(); ++code) {
    const float half = halves ? glm::unpackHalf1x16(std::uint16_t(code)) : 0.0f;
    const double value = halves ? double(half) * encoding.scale : encoding.offset + (double(code) - 1.0) * encoding.scale;
    values_[code] = std::isfinite(half) ? float(std::clamp(value, -kLargestValue, kLargestValue)) : std::numeric_limits<float>::quiet_NaN();
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
