#include "apps/view/image_pace.h"

#include <gtest/gtest.h>

#include <cmath>

namespace freevoxels {
namespace {

using std::chrono::milliseconds;

TEST(ImageRate, IsThatOfTheLastTwoSeconds) {
  ImageRate rate;
  ImageRate::Clock::time_point now{};
  for (int i = 0; i < 10; ++i) rate.add(now += milliseconds(200));
  EXPECT_DOUBLE_EQ(rate.perSecond(), 5.0);
  for (int i = 0; i < 40; ++i) rate.add(now += milliseconds(50));
  EXPECT_DOUBLE_EQ(rate.perSecond(), 20.0);
}

TEST(ImageRate, BeginsAnewAfterAPause) {
  ImageRate rate;
  ImageRate::Clock::time_point now{};
  EXPECT_EQ(rate.perSecond(), 0.0);
  for (int i = 0; i < 5; ++i) rate.add(now += milliseconds(100));
  EXPECT_DOUBLE_EQ(rate.perSecond(), 10.0);
  rate.add(now += milliseconds(3000));
  EXPECT_EQ(rate.perSecond(), 0.0) << "one image has no rate";
  rate.add(now += milliseconds(250));
  rate.add(now += milliseconds(250));
  EXPECT_DOUBLE_EQ(rate.perSecond(), 4.0);
}

/// Milliseconds of an image, for splats and for pixels.
double timeOf(const AdaptiveResolution& pace, double splats, double pixels) {
  const double voxels = pace.voxelsAlongEdge() / 64.0;
  return splats * voxels * voxels * voxels + 4.0 * pixels * pace.quality() * pace.quality();
}

TEST(AdaptiveResolution, ComesToImagesThatAreQuickEnoughAndStays) {
  for (const double splats : {1.0, 30.0, 100.0, 150.0, 1000.0})
    for (const double pixels : {1.0, 20.0, 100.0, 400.0}) {
      AdaptiveResolution pace(AdaptiveResolution::Voxels::Fewer);
      int changes = 0;
      for (int i = 0; i < 120; ++i) {
        const int before = pace.voxelsAlongEdge();
        pace.took(timeOf(pace, splats, pixels));
        changes += pace.voxelsAlongEdge() != before;
      }
      EXPECT_LE(changes, 4) << splats << " " << pixels;
      EXPECT_TRUE(pace.voxelsAlongEdge() == 96 || timeOf(pace, splats, pixels) < 60.0)
          << splats << " " << pixels << " " << pace.voxelsAlongEdge();
    }
}

TEST(AdaptiveResolution, IsAsFineAsTimeAllows) {
  AdaptiveResolution pace(AdaptiveResolution::Voxels::Fewer);
  for (int i = 0; i < 20; ++i) pace.took(500.0);
  EXPECT_EQ(pace.voxelsAlongEdge(), 96) << "fewer do not show what is edited";
  for (int i = 0; i < 2000; ++i) pace.took(timeOf(pace, 2.0, 5.0));
  EXPECT_EQ(pace.voxelsAlongEdge(), 128);
  EXPECT_EQ(pace.quality(), 1.0);
}

TEST(AdaptiveResolution, DoesNotChangeTheVoxelsForOneSlowImage) {
  AdaptiveResolution pace(AdaptiveResolution::Voxels::Fewer);
  for (int i = 0; i < 10; ++i) pace.took(32.0);
  const int before = pace.voxelsAlongEdge();
  pace.took(5000.0);
  EXPECT_EQ(pace.voxelsAlongEdge(), before);
}

TEST(AdaptiveResolution, OfAllVoxelsKeepsThemHoweverSlowImagesAre) {
  AdaptiveResolution pace(AdaptiveResolution::Voxels::All);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(pace.voxelsAlongEdge(), kAllVoxels);
    pace.took(2000.0);
  }
  EXPECT_EQ(pace.quality(), DraftQuality::kLeast);
  for (int i = 0; i < 100; ++i) pace.took(5.0);
  EXPECT_EQ(pace.quality(), 1.0);
}

/// An image of half the quality takes a quarter of the time.
TEST(AdaptiveResolution, BeginsWithTheQualityForWhichTheWholeImageSaysThatThereIsTime) {
  AdaptiveResolution pace(AdaptiveResolution::Voxels::All);
  pace.beginFrom(400.0);
  EXPECT_NEAR(pace.quality() * pace.quality() * 400.0, 46.0, 1.0);
  pace.beginFrom(10.0);
  EXPECT_EQ(pace.quality(), 1.0);
}

/// Drafts may take longer than the whole image says, as they make what that had kept.
TEST(AdaptiveResolution, BelievesTheFirstImageMoreThanTheWholeOne) {
  AdaptiveResolution pace(AdaptiveResolution::Voxels::All);
  pace.beginFrom(400.0);
  const double first = pace.quality();
  pace.took(920.0);
  EXPECT_NEAR(pace.quality(), first * std::sqrt(46.0 / 920.0), 1e-3);
  const double second = pace.quality();
  pace.took(920.0);
  EXPECT_NEAR(pace.quality(), 0.75 * second, 1e-9) << "those after it slowly";
}

}  // namespace
}  // namespace freevoxels
