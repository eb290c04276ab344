#include "engine/volume/scalar_bricks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "engine/core/error.h"

namespace freevoxels {
namespace {

/// Data in a few voxels, far apart.
float scalarOf(glm::ivec3 v) {
  return (v.x * 31 + v.y * 17 + v.z * 7) % 97 == 0 ? float(v.x + 100 * v.y + 10000 * v.z) : kInactiveVoxel;
}

template <typename Visit>
void forEachVoxel(glm::ivec3 size, const Visit& visit) {
  for (glm::ivec3 v(0); v.z < size.z; ++v.z)
    for (v.y = 0; v.y < size.y; ++v.y)
      for (v.x = 0; v.x < size.x; ++v.x) visit(v);
}

TEST(ScalarBricks, KeepsEveryScalarWhereverTheBoxBeginsInItsFirstBrick) {
  const glm::ivec3 size(19, 8, 33);
  for (const glm::ivec3 corner : {glm::ivec3(0), glm::ivec3(7, 0, 3), glm::ivec3(7)}) {
    ScalarBricks bricks(size, corner);
    forEachVoxel(size, [&](glm::ivec3 v) {
      EXPECT_EQ(bricks.at(v), kInactiveVoxel);
      if (scalarOf(v) != kInactiveVoxel) bricks.set(v, scalarOf(v));
    });
    forEachVoxel(size, [&](glm::ivec3 v) { EXPECT_EQ(bricks.at(v), scalarOf(v)); });
    for (std::size_t i = 0; i < bricks.count(); ++i) EXPECT_EQ((bricks.firstVoxel(i) + corner) % ScalarBricks::kEdge, glm::ivec3(0));
  }
}

TEST(ScalarBricks, ProgressMayAbandonAndChangesNothing) {
  for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(70, 65, 130), glm::ivec3(200, 9, 300)}) {
    const auto everywhere = [](glm::ivec3) { return true; };
    std::vector<double> fractions;
    const ScalarBricks plain = ScalarBricks::make(size, scalarOf);
    const Progress report = [&](std::string_view, double fraction) { fractions.push_back(fraction); };
    const ScalarBricks reported = ScalarBricks::make(size, scalarOf, everywhere, report);
    ASSERT_EQ(reported.count(), plain.count());
    for (std::size_t i = 0; i < plain.count(); ++i) {
      EXPECT_EQ(reported.cell(i), plain.cell(i));
      EXPECT_EQ(reported.brick(i), plain.brick(i));
    }
    const glm::ivec3 cells = plain.cells();
    EXPECT_GE(fractions.size(), std::size_t(cells.x) * std::size_t(cells.y) * std::size_t(cells.z) / 512);
    EXPECT_TRUE(std::ranges::is_sorted(fractions));
    std::size_t left = fractions.size();
    const auto abandon = [&] { ScalarBricks::make(size, scalarOf, everywhere, [&](std::string_view, double) { if (--left == 0) throw left; }); };
    EXPECT_THROW(abandon(), std::size_t);
  }
}

TEST(ScalarBricks, OnlyBricksWithDataTakeMemory) {
  const glm::ivec3 size(64);
  const ScalarBricks bricks = ScalarBricks::make(
      size, [](glm::ivec3 v) { return v.x < 8 && v.y >= 56 && v.z / 8 == 3 ? 1.0f : kInactiveVoxel; });
  EXPECT_EQ(bricks.count(), 1u);
  EXPECT_EQ(bricks.firstVoxel(0), glm::ivec3(0, 56, 24));
  EXPECT_LT(bricks.bytes(), 64u * 64 * 64 * sizeof(float) / 100);
}

TEST(ScalarBricks, AFunctionFillsTheSameBricksInEveryRun) {
  const glm::ivec3 size(35, 41, 20);
  const ScalarBricks bricks = ScalarBricks::make(size, scalarOf);
  forEachVoxel(size, [&](glm::ivec3 v) { ASSERT_EQ(bricks.at(v), scalarOf(v)); });
  const ScalarBricks again = ScalarBricks::make(size, scalarOf);
  ASSERT_EQ(again.count(), bricks.count());
  for (std::size_t i = 0; i < bricks.count(); ++i) {
    EXPECT_EQ(again.firstVoxel(i), bricks.firstVoxel(i));
    EXPECT_EQ(again.brick(i), bricks.brick(i));
  }
}

TEST(ScalarBricks, CroppingKeepsTheScalarsOfTheRest) {
  const glm::ivec3 size(30, 21, 26), low(5, 8, 9), high(28, 15, 17);
  const ScalarBricks bricks = ScalarBricks::make(size, [&](glm::ivec3 v) {
    return glm::all(glm::greaterThanEqual(v, low)) && glm::all(glm::lessThanEqual(v, high)) ? scalarOf(v)
                                                                                            : kInactiveVoxel;
  });
  const ScalarBricks cropped = bricks.cropped(low, high);
  EXPECT_EQ(cropped.dimensions(), high - low + 1);
  forEachVoxel(cropped.dimensions(), [&](glm::ivec3 v) { EXPECT_EQ(cropped.at(v), scalarOf(low + v)); });
}

TEST(ScalarBricks, ABrickBeyondTheBoxOrThereTwiceIsABug) {
  for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(19, 8, 33), glm::ivec3(8, 8, 8)}) {
    const glm::ivec3 cells = ScalarBricks(size).cells();
    for (int axis = 0; axis < 3; ++axis)
      for (const int place : {-1, cells[axis], 1 << 20, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
        glm::ivec3 cell(0);
        cell[axis] = place;
        ScalarBricks bricks(size);
        EXPECT_THROW(bricks.makeBrick(cell), InternalError);
        EXPECT_THROW(ScalarBricks::of(size, {cell}, ScalarBricks::Bricks(1)), InternalError);
      }
    EXPECT_THROW(ScalarBricks::of(size, {glm::ivec3(0), glm::ivec3(0)}, ScalarBricks::Bricks(2)), InternalError);
    EXPECT_THROW(ScalarBricks::of(size, {glm::ivec3(0)}, {}), InternalError);
  }
}

/// The same scalars as codes of 8 and of 16 bits, and as floats, in a box that ends inside of bricks. Some have no data.
struct CodedBricks {
  static constexpr glm::ivec3 kSize{19, 8, 21};
  static float valueOf(std::size_t code) { return code % 7 == 3 ? kInactiveVoxel : 0.25f * float(code) - 9.0f; }
  static std::size_t codeAt(glm::ivec3 v) { return std::size_t(v.x * 31 + v.y * 17 + v.z * 5) % 256; }
  template <typename Code>
  static ScalarBricks coded() {
    std::vector<float> values(std::size_t(1) << 8 * sizeof(Code));
    for (std::size_t code = 0; code < values.size(); ++code) values[code] = valueOf(code);
    return ScalarBricks::makeCodes<Code>(
        kSize, [](glm::ivec3 v) { return Code(codeAt(v)); }, std::move(values));
  }
  const ScalarBricks floats = ScalarBricks::make(kSize, [](glm::ivec3 v) { return valueOf(codeAt(v)); });
  const std::array<ScalarBricks, 2> codes{coded<std::uint8_t>(), coded<std::uint16_t>()};
};

TEST(ScalarBricks, CodesHaveTheScalarsOfFloats) {
  const CodedBricks same;
  for (const ScalarBricks& codes : same.codes) {
    const std::size_t bytesOfCode = codes.values().size() == 256 ? 1 : 2;
    EXPECT_EQ(codes.bytes() - codes.values().size() * sizeof(float),
              same.floats.bytes() - codes.count() * ScalarBricks::kVoxels * (sizeof(float) - bytesOfCode));
    ASSERT_EQ(codes.count(), same.floats.count());
    for (std::size_t i = 0; i < codes.count(); ++i) {
      EXPECT_EQ(codes.cell(i), same.floats.cell(i));
      EXPECT_EQ(codes.brick(i), same.floats.brick(i)) << "beyond the box, too";
    }
    std::vector<float> row(std::size_t(CodedBricks::kSize.x)), expected(row);
    codes.copyRow(7, 20, row);
    same.floats.copyRow(7, 20, expected);
    EXPECT_EQ(row, expected);
    forEachVoxel(CodedBricks::kSize, [&](glm::ivec3 v) { EXPECT_EQ(codes.at(v), same.floats.at(v)); });
  }
}

TEST(ScalarBricks, CodesAreCountedInTheBoxOnly) {
  const CodedBricks same;
  std::vector<std::uint64_t> expected(256);
  forEachVoxel(CodedBricks::kSize, [&](glm::ivec3 v) { ++expected[CodedBricks::codeAt(v)]; });
  for (const ScalarBricks& codes : same.codes) {
    std::vector<std::uint64_t> counts = codes.codeCounts();
    counts.resize(expected.size());
    EXPECT_EQ(counts, expected);
  }
}

TEST(ScalarBricks, CroppedCodesStayCodes) {
  const CodedBricks same;
  const glm::ivec3 low(5, 1, 9), high(17, 6, 17);
  const ScalarBricks expected = same.floats.cropped(low, high);
  for (const ScalarBricks& codes : same.codes) {
    const ScalarBricks cropped = codes.cropped(low, high);
    EXPECT_FALSE(cropped.values().empty());
    ASSERT_EQ(cropped.count(), expected.count());
    for (std::size_t i = 0; i < cropped.count(); ++i) EXPECT_EQ(cropped.brick(i), expected.brick(i));
  }
}

TEST(ScalarBricks, CodesThatAreChangedBecomeFloats) {
  for (ScalarBricks codes : CodedBricks().codes) {
    const ScalarBricks before = codes;
    codes.set({2, 3, 4}, 77.0f);
    EXPECT_TRUE(codes.values().empty());
    forEachVoxel(CodedBricks::kSize, [&](glm::ivec3 v) { EXPECT_EQ(codes.at(v), v == glm::ivec3(2, 3, 4) ? 77.0f : before.at(v)); });
    ScalarBricks edited = before;
    ASSERT_EQ(edited.editable().size(), before.count());
    for (std::size_t i = 0; i < before.count(); ++i) EXPECT_EQ(edited.brick(i), before.brick(i));
  }
}

TEST(ScalarBricks, MappedCodesAreMappedScalars) {
  const CodedBricks same;
  const auto twice = [](float scalar) { return scalar == kInactiveVoxel ? -1.0 : 2.0 * double(scalar); };
  for (const ScalarBricks& codes : same.codes) {
    const std::vector<double> ofCodes = codes.mapValues<double>(twice);
    for (std::size_t i = 0; i < codes.count(); ++i) {
      std::array<double, ScalarBricks::kVoxels> mapped, expected;
      codes.mapBrick(i, std::span<double>(mapped), twice, std::span<const double>(ofCodes));
      same.floats.mapBrick(i, std::span<double>(expected), twice, std::span<const double>());
      EXPECT_EQ(mapped, expected);
    }
  }
}

TEST(ScalarBricks, EmptyBricksOfCodesAreLeftOut) {
  std::vector<float> values(256, 1.0f);
  values[5] = kInactiveVoxel;
  const ScalarBricks codes = ScalarBricks::makeCodes<std::uint8_t>(
      glm::ivec3(24, 8, 8), [](glm::ivec3 v) { return std::uint8_t(v == glm::ivec3(12, 3, 3) ? 9 : 5); }, std::move(values));
  ASSERT_EQ(codes.count(), 1u);
  EXPECT_EQ(codes.cell(0), glm::ivec3(1, 0, 0));
}

TEST(ScalarBricks, TheLongestBoxTakesTheMemoryOfItsBricks) {
  const glm::ivec3 size((1 << 30) - 3), last = size - 1;
  ScalarBricks bricks(size, glm::ivec3(5, 0, 7));
  EXPECT_EQ(bricks.at(last), kInactiveVoxel);
  bricks.set(glm::ivec3(0), 1.0f);
  bricks.set(last, 2.0f);
  EXPECT_EQ(bricks.at(glm::ivec3(0)), 1.0f);
  EXPECT_EQ(bricks.at(last), 2.0f);
  EXPECT_EQ(bricks.at(last - 1), kInactiveVoxel);
  EXPECT_EQ(bricks.at({0, last.y, 0}), kInactiveVoxel);
  EXPECT_EQ(bricks.count(), 2u);
  EXPECT_LT(bricks.bytes(), 1u << 14);
  EXPECT_EQ(bricks.cropped(last - 20, last).at(glm::ivec3(20)), 2.0f);
}

}  // namespace
}  // namespace freevoxels
