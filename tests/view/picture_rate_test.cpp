#include "apps/view/picture_rate.h"

#include <gtest/gtest.h>

namespace freevoxels {
namespace {

using std::chrono::milliseconds;

TEST(PictureRate, IsThatOfTheLastTwoSeconds) {
  PictureRate rate;
  PictureRate::Clock::time_point now{};
  for (int i = 0; i < 10; ++i) rate.add(now += milliseconds(200));
  EXPECT_DOUBLE_EQ(rate.perSecond(), 5.0);
  for (int i = 0; i < 40; ++i) rate.add(now += milliseconds(50));
  EXPECT_DOUBLE_EQ(rate.perSecond(), 20.0);
}

TEST(PictureRate, BeginsAnewAfterAPause) {
  PictureRate rate;
  PictureRate::Clock::time_point now{};
  EXPECT_EQ(rate.perSecond(), 0.0);
  for (int i = 0; i < 5; ++i) rate.add(now += milliseconds(100));
  EXPECT_DOUBLE_EQ(rate.perSecond(), 10.0);
  rate.add(now += milliseconds(3000));
  EXPECT_EQ(rate.perSecond(), 0.0) << "one picture has no rate";
  rate.add(now += milliseconds(250));
  rate.add(now += milliseconds(250));
  EXPECT_DOUBLE_EQ(rate.perSecond(), 4.0);
}

}  // namespace
}  // namespace freevoxels
