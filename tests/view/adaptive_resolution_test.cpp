#include "apps/view/adaptive_resolution.h"

#include <gtest/gtest.h>

namespace freevoxels {
namespace {

/// Milliseconds of a picture, for splats and for pixels.
double timeOf(const AdaptiveResolution& pace, double splats, double pixels) {
  const double voxels = pace.voxelsAlongEdge() / 64.0;
  return splats * voxels * voxels * voxels + pixels * pace.scale() * pace.scale();
}

TEST(AdaptiveResolution, ComesToPicturesThatAreQuickEnoughAndStays) {
  for (const double splats : {1.0, 30.0, 100.0, 150.0, 1000.0})
    for (const double pixels : {1.0, 20.0, 100.0, 400.0}) {
      AdaptiveResolution pace;
      int changes = 0;
      for (int i = 0; i < 120; ++i) {
        const int before = pace.voxelsAlongEdge();
        pace.took(timeOf(pace, splats, pixels));
        changes += pace.voxelsAlongEdge() != before;
      }
      EXPECT_LE(changes, 4) << splats << " " << pixels;
      EXPECT_LT(timeOf(pace, splats, pixels), 60.0)
          << splats << " " << pixels << " " << pace.voxelsAlongEdge();
    }
}

TEST(AdaptiveResolution, IsAsFineAsTimeAllows) {
  AdaptiveResolution pace;
  for (int i = 0; i < 20; ++i) pace.took(500.0);
  EXPECT_LT(pace.voxelsAlongEdge(), 48);
  for (int i = 0; i < 1000; ++i) pace.took(timeOf(pace, 5.0, 20.0));
  EXPECT_EQ(pace.voxelsAlongEdge(), 64);
  EXPECT_EQ(pace.scale(), 1.0);
}

TEST(AdaptiveResolution, DoesNotChangeTheVoxelsForOneSlowPicture) {
  AdaptiveResolution pace;
  for (int i = 0; i < 10; ++i) pace.took(32.0);
  const int before = pace.voxelsAlongEdge();
  pace.took(5000.0);
  EXPECT_EQ(pace.voxelsAlongEdge(), before);
}

}  // namespace
}  // namespace freevoxels
