#include "voxlist/fleet/throttle.h"

#include <gtest/gtest.h>

namespace voxlist::fleet {
namespace {

// Messages that pass of those offered at a rate for so long.
int passed(Throttle& throttle, double hz, double seconds, std::size_t bytes) {
  int count = 0;
  for (int i = 0; i < static_cast<int>(hz * seconds); ++i)
    if (throttle.pass(bytes, static_cast<std::int64_t>(i / hz * 1e6))) ++count;
  return count;
}

TEST(Throttle, LetsPassWhatIsSlower) {
  Throttle throttle(10.0, 1e6);
  EXPECT_EQ(passed(throttle, 9.0, 10.0, 100), 90);
}

TEST(Throttle, HoldsItsRate) {
  Throttle throttle(10.0, 1e6);
  EXPECT_NEAR(passed(throttle, 50.0, 20.0, 100), 10 * 20 + 10, 2);
}

TEST(Throttle, HoldsItsBytes) {
  Throttle throttle(1000.0, 10'000.0);
  EXPECT_NEAR(passed(throttle, 50.0, 20.0, 1000), 10 * 20 + 10, 2);
}

TEST(Throttle, LetsOneLargeMessagePassWholeAndIsPaidForIt) {
  Throttle throttle(10.0, 1000.0);
  EXPECT_TRUE(throttle.pass(5000, 0));
  EXPECT_FALSE(throttle.pass(1, 3'900'000));
  EXPECT_TRUE(throttle.pass(1, 4'100'000));
}

TEST(Throttle, LetsTheFirstPassAtAnyRate) {
  Throttle throttle(0.1, 1000.0);
  EXPECT_TRUE(throttle.pass(1, 0));
  EXPECT_FALSE(throttle.pass(1, 9'900'000));
  EXPECT_TRUE(throttle.pass(1, 10'100'000));
}

TEST(Throttle, EarnsNothingWhenTimeGoesBack) {
  Throttle throttle(1.0, 1000.0);
  EXPECT_TRUE(throttle.pass(1, 10'000'000));
  EXPECT_FALSE(throttle.pass(1, 0));
  EXPECT_TRUE(throttle.pass(1, 1'000'000));
}

}  // namespace
}  // namespace voxlist::fleet
