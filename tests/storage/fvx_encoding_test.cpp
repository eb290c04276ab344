#include "engine/storage/fvx_encoding.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "engine/volume/scalar_bricks.h"

namespace freevoxels::fvx {
namespace {

std::vector<float> throughFile(const Encoding& encoding, const std::vector<float>& values) {
  std::vector<std::byte> bytes(values.size() * encoding.bytesPerValue());
  encode(encoding, values, bytes);
  std::vector<float> result(values.size());
  EXPECT_TRUE(Decoder(encoding).decode(bytes, result));
  return result;
}

TEST(FvxEncoding, Float32KeepsEveryBit) {
  const std::vector<float> values{0.0f, -1.5f, 1e-30f, std::numeric_limits<float>::max(), kInactiveVoxel};
  EXPECT_EQ(throughFile({}, values), values);
}

TEST(FvxEncoding, Float16HasARelativeErrorOfAtMostOnePartIn2048OverNineDecades) {
  const Encoding encoding{.kind = EncodingKind::Float16, .scale = 0.37};
  for (double value = 1e-4; value < 2e4; value *= 1.37) {
    const float stored = throughFile(encoding, {float(value)}).front();
    EXPECT_NEAR(stored, value, value / 2048.0 * 1.001);
  }
}

TEST(FvxEncoding, Float16ClampsWhatIsTooLargeAndKeepsZeroAndInactive) {
  const Encoding encoding{.kind = EncodingKind::Float16, .scale = 0.5};
  EXPECT_EQ(throughFile(encoding, {0.0f, kInactiveVoxel, 1e9f}), (std::vector<float>{0.0f, kInactiveVoxel, 32752.0f}));
}

TEST(FvxEncoding, Float16OfADecodedValueIsTheSameHalf) {
  const Encoding encoding{.kind = EncodingKind::Float16, .scale = 0.0123456789};
  for (double value = 1e-6; value < 700.0; value *= 1.1) {
    const float once = throughFile(encoding, {float(value)}).front();
    EXPECT_EQ(throughFile(encoding, {once}).front(), once) << value;
  }
}

TEST(FvxEncoding, Linear16HasAnErrorOfAtMostHalfAStepAndKeepsInactive) {
  const Encoding encoding{.kind = EncodingKind::Linear16, .scale = 4000.0 / 65534.0, .offset = -1000.0};
  for (double value = -1000.0; value <= 3000.0; value += 12.345)
    EXPECT_NEAR(throughFile(encoding, {float(value)}).front(), value, 0.501 * encoding.scale);
  EXPECT_EQ(throughFile(encoding, {kInactiveVoxel}).front(), kInactiveVoxel);
  EXPECT_EQ(throughFile(encoding, {-1e9f}).front(), -1000.0f);
}

TEST(FvxEncoding, Linear16OfOneValueOnlyHasThatValue) {
  EXPECT_EQ(throughFile({.kind = EncodingKind::Linear16, .scale = 0.0, .offset = 7.5}, {7.5f}).front(), 7.5f);
}

TEST(FvxEncoding, TheDecodedRangeOfAValueHoldsWhatItBecomesAndFewOthers) {
  const auto expectHeld = [](const Encoding& encoding, double value, double widest) {
    const float stored = throughFile(encoding, {float(value)}).front();
    const auto [low, high] = encoding.decodedRange(float(value), float(value));
    EXPECT_TRUE(low <= stored && stored <= high) << value << " as " << stored << " in " << low << " to " << high;
    EXPECT_LE(double(high) - low, widest) << value;
  };
  constexpr double kLargest = std::numeric_limits<float>::max(), kLeast = std::numeric_limits<float>::denorm_min();
  for (const double sign : {1.0, -1.0})
    for (double size = 1e-44; size < kLargest; size *= 17.0) {
      const double value = sign * size;
      expectHeld({}, value, 0.0);
      for (const double scale : {1e-300, 1e-50, 1e-42, 1e-20, 0.37, 1e20, 1e38, 1e50}) {
        const double held = std::min(size, 65504.0 * scale);
        expectHeld({.kind = EncodingKind::Float16, .scale = scale}, value, std::max({held * 0x1.1p-9, scale * 0x1.1p-23, 2.0 * kLeast}));
        for (const double offset : {0.0, -1000.0, 3e37})
          expectHeld({.kind = EncodingKind::Linear16, .scale = scale, .offset = offset}, value,
                     2.1 * scale + 0x1.1p-21 * std::max(std::abs(offset), size) + 2.0 * kLeast);
      }
    }
}

TEST(FvxEncoding, NaNAndInfinitiesAreSaidWhateverTheEncoding) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto isSound = [](const Decoder& decoder, auto value) {
    std::array<decltype(value), 3> stored{};
    stored[1] = value;
    std::array<float, 3> values;
    return decoder.decode(std::as_bytes(std::span(stored)), values);
  };
  const Decoder floats({}), halves({.kind = EncodingKind::Float16, .scale = 2.0}), codes({.kind = EncodingKind::Linear16, .scale = 1.0});
  for (const float value : {kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::signaling_NaN()})
    EXPECT_FALSE(isSound(floats, value));
  for (const float value : {0.0f, -0.0f, 1e-45f, std::numeric_limits<float>::max(), kInactiveVoxel}) EXPECT_TRUE(isSound(floats, value));
  for (int code = 0; code <= 0xffff; ++code) {
    const bool isFinite = (code & 0x7c00) != 0x7c00 || code == 0xffff;
    EXPECT_EQ(isSound(halves, std::uint16_t(code)), isFinite) << code;
    EXPECT_TRUE(isSound(codes, std::uint16_t(code)));
  }
}

TEST(FvxEncoding, NoScaleMakesAFiniteCodeInfiniteOrAValueWithoutData) {
  for (const EncodingKind kind : {EncodingKind::Float16, EncodingKind::Linear16})
    for (const double scale : {0.0, 1e-300, 1e35, 1e300}) {
      const Encoding encoding{.kind = kind, .scale = scale, .offset = -1e38};
      for (const int number : {0x0001, 0x7bff, 0xfbff, 0x8001}) {
        const auto code = std::uint16_t(number);
        float value = 0.0f;
        EXPECT_TRUE(Decoder(encoding).decode(std::as_bytes(std::span(&code, 1)), std::span(&value, 1)));
        EXPECT_TRUE(std::isfinite(value) && value != kInactiveVoxel) << value;
      }
    }
}

}  // namespace
}  // namespace freevoxels::fvx
