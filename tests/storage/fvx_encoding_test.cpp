#include "engine/storage/fvx_encoding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/volume/scalar_bricks.h"

namespace freevoxels::fvx {
namespace {

std::vector<float> throughFile(const Encoding& encoding, const std::vector<float>& values) {
  std::vector<std::byte> bytes(values.size() * encoding.bytesPerValue());
  encode(encoding, values, bytes);
  std::vector<float> result(values.size());
  Decoder(encoding).decode(bytes, result);
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

}  // namespace
}  // namespace freevoxels::fvx
