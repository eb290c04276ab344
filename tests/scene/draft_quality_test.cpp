#include "engine/scene/draft_quality.h"

#include <gtest/gtest.h>

#include <initializer_list>

namespace freevoxels {
namespace {

/// Milliseconds of a frame whose whole takes `whole`, of which `fixed` do not depend on the quality.
double timeOf(double quality, double whole, double fixed) {
  return fixed + (whole - fixed) * quality * quality;
}

TEST(DraftQuality, BeginsWithTheQualityForWhichAFrameSaysThatThereIsTime) {
  DraftQuality draft(40.0);
  draft.beginFrom(400.0, 1.0);
  EXPECT_NEAR(timeOf(draft.quality(), 400.0, 0.0), 40.0, 1e-9);
  draft.beginFrom(100.0, 0.5);
  EXPECT_NEAR(timeOf(draft.quality(), 400.0, 0.0), 40.0, 1e-9);
  draft.beginFrom(10.0, 1.0);
  EXPECT_EQ(draft.quality(), 1.0);
  draft.beginFrom(1e9, 1.0);
  EXPECT_EQ(draft.quality(), DraftQuality::kLeast);
}

TEST(DraftQuality, ComesToTheBudgetAndStays) {
  for (const double whole : {60.0, 300.0, 2000.0})
    for (const double fixed : {0.0, 10.0}) {
      DraftQuality draft(40.0);
      for (int i = 0; i < 60; ++i) draft.took(timeOf(draft.quality(), whole, fixed));
      for (int i = 0; i < 20; ++i) {
        EXPECT_NEAR(timeOf(draft.quality(), whole, fixed), 40.0, 4.0) << whole << " " << fixed;
        draft.took(timeOf(draft.quality(), whole, fixed));
      }
    }
}

TEST(DraftQuality, IsHardlyMovedByASingleSlowFrame) {
  DraftQuality draft(40.0);
  draft.beginFrom(400.0, 1.0);
  const double before = draft.quality();
  draft.took(5000.0);
  EXPECT_GT(draft.quality(), 0.7 * before);
}

TEST(DraftQuality, EndsAtTheLeastAndAtTheWhole) {
  DraftQuality draft(40.0);
  for (int i = 0; i < 30; ++i) draft.took(1e6);
  EXPECT_EQ(draft.quality(), DraftQuality::kLeast);
  for (int i = 0; i < 60; ++i) draft.took(0.0);
  EXPECT_EQ(draft.quality(), 1.0);
  DraftQuality better(40.0, 0.3);
  for (int i = 0; i < 30; ++i) better.took(1e6);
  EXPECT_EQ(better.quality(), 0.3);
}

}  // namespace
}  // namespace freevoxels
