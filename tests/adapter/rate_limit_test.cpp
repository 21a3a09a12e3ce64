#include "voxlist/adapter/rate_limit.h"

#include <gtest/gtest.h>

namespace voxlist::adapter {
namespace {

// How many of those that come at even steps for 10 s go through.
int through(double limit_hz, double rate_hz, std::int64_t jitter_us = 0) {
  RateLimit limit(limit_hz);
  int n = 0;
  for (int i = 0; i < static_cast<int>(10.0 * rate_hz); ++i)
    n += limit.lets(static_cast<std::int64_t>(i * 1e6 / rate_hz) + (i % 2 == 0 ? jitter_us : 0));
  return n;
}

TEST(RateLimit, HalvesWhatIsTwiceAsFast) { EXPECT_NEAR(through(5.0, 10.0), 52, 2); }

TEST(RateLimit, LetsThroughSoManyASecondInTheMean) {
  EXPECT_NEAR(through(10.0, 12.0), 105, 1);
  EXPECT_NEAR(through(3.0, 20.0), 31, 1);
}

TEST(RateLimit, LosesNothingOfItsOwnRateToAPeriodThatWavers) {
  EXPECT_GE(through(10.0, 10.0, 10'000), 99);
  EXPECT_EQ(through(20.0, 10.0), 100);
}

TEST(RateLimit, LosesNothingOfALaserThatTurnsALittleTooFast) {
  EXPECT_EQ(through(10.0, 10.3), 103);
}

TEST(RateLimit, StartsAnewWithTime) {
  RateLimit limit(1.0);
  EXPECT_TRUE(limit.lets(100'000'000));
  EXPECT_FALSE(limit.lets(100'100'000));
  EXPECT_TRUE(limit.lets(0));
}

}  // namespace
}  // namespace voxlist::adapter
