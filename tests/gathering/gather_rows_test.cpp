#include "engine/gathering/gather_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "engine/core/error.h"

namespace freevoxels {
namespace {

shader::GatherFrame frameOf(int first, int rows) {
  shader::GatherFrame frame{};
  frame.samples = {20, first + rows + 7};
  frame.firstSeen = {0, first};
  frame.seenExtent = {19, rows};
  frame.ownCells = {0, (rows + 1) / 2};
  frame.sampleTolerance = 0.1f;
  return frame;
}

TEST(RowsOfPart, EveryRowIsInOnePartAndPartsBeginWithCoarseRows) {
  for (const int rows : {1, 3, 17, 101, 1023})
    for (const int count : {1, 2, 3, 7, 64, 256}) {
      const shader::GatherFrame frame = frameOf(4, rows);
      int next = 4;
      for (int part = 0; part < count; ++part) {
        const glm::ivec2 own = rowsOfPart(frame, {part, count});
        EXPECT_EQ(own.x, next);
        EXPECT_GE(own.y, own.x);
        if (own.y > own.x) {
          EXPECT_EQ((own.x - 4) % 2, 0);
        }
        next = own.y;
      }
      EXPECT_EQ(next, 4 + rows) << count;
    }
}

TEST(RowsOfPart, PartsAreAboutEqual) {
  for (int part = 0; part < 7; ++part) {
    const glm::ivec2 rows = rowsOfPart(frameOf(0, 201), {part, 7});
    EXPECT_GE(rows.y - rows.x, 26);
    EXPECT_LE(rows.y - rows.x, 30);
  }
}

TEST(RowsOfPart, PartsOfDifferentNumbersMeet) {
  const shader::GatherFrame frame = frameOf(0, 333);
  EXPECT_EQ(rowsOfPart(frame, {1, 2}).x, rowsOfPart(frame, {2, 4}).x);
  EXPECT_EQ(rowsOfPart(frame, {0, 1}).y, rowsOfPart(frame, {255, 256}).y);
}

TEST(FrameOfRows, HasItsRowsAloneWhereAllSamplesAreMarched) {
  shader::GatherFrame frame = frameOf(4, 101);
  frame.sampleTolerance = 0.0f;
  const glm::ivec2 rows = rowsOfPart(frame, {2, 5});
  EXPECT_EQ(frameOfRows(frame, rows).firstSeen.y, rows.x);
  EXPECT_EQ(frameOfRows(frame, rows).seenExtent.y, rows.y - rows.x);
}

TEST(AddSamples, LightBeyondTheRangeIsRefused) {
  const shader::GatherFrame frame = frameOf(0, 3);
  FixedSums sums = sumsOfSamples(frame, false, {.size = {4, 4}, .digits = {40, 40, 40, 50, 0, 40}});
  std::vector<GatherSums> samples(std::size_t(frame.samples.x) * std::size_t(frame.samples.y));
  EXPECT_NO_THROW(addSamples(sums, samples, {0, 3}));
  for (const double value : {1e30, -1e30, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    samples[1].color = glm::dvec3(value);
    EXPECT_THROW(addSamples(sums, samples, {0, 3}), Error);
  }
}

TEST(FrameOfRows, HasTheCoarseSamplesThatItsCellsRead) {
  const shader::GatherFrame frame = frameOf(4, 101);
  for (const int count : {1, 2, 5, 51}) {
    for (int part = 0; part < count; ++part) {
      const glm::ivec2 rows = rowsOfPart(frame, {part, count});
      if (rows.x == rows.y) continue;
      const shader::GatherFrame own = frameOfRows(frame, rows);
      EXPECT_EQ(own.firstSeen.y % 2, 0);
      EXPECT_EQ(own.seenExtent.y % 2, 1);
      // Two coarse rows before the cells, and from the last cell on that at its end and two more, unless the lattice ends.
      EXPECT_EQ(own.firstSeen.y, std::max(rows.x - 4, 4));
      EXPECT_EQ(own.firstSeen.y + own.seenExtent.y, std::min(4 + 2 * ((rows.y - 4 + 1) / 2) + 5, 4 + 101));
      EXPECT_EQ(own.firstSeen.y + 2 * own.ownCells.x, rows.x);
      EXPECT_EQ(own.ownCells.y - own.ownCells.x, (rows.y - rows.x + 1) / 2);
    }
  }
}

}  // namespace
}  // namespace freevoxels
