#include "voxlist/simulation/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace voxlist::simulation {
namespace {

TEST(Random, GivesTheSameBitsEverywhere) {
  Random random(42);
  EXPECT_EQ(random.bits(), 0xf41fcdc32a9a6775ULL);
  EXPECT_EQ(random.bits(), 0xa046284fdf796ecfULL);
}

TEST(Random, HasStreamsThatDiffer) {
  EXPECT_NE(Random(42, 0).bits(), Random(42, 1).bits());
  EXPECT_NE(Random(42, 0).bits(), Random(43, 0).bits());
}

TEST(Random, IsUniformWithinItsBounds) {
  Random random(7);
  double sum = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const double value = random.uniform(-1.0, 3.0);
    ASSERT_GE(value, -1.0);
    ASSERT_LT(value, 3.0);
    sum += value;
  }
  EXPECT_NEAR(sum / 10000, 1.0, 4 * std::sqrt(16.0 / 12.0 / 10000));
}

TEST(Random, IsNormalWithMeanZeroAndDeviationOne) {
  Random random(7);
  double sum = 0.0, squares = 0.0;
  int beyond_two = 0;
  for (int i = 0; i < 10000; ++i) {
    const double value = random.normal();
    sum += value;
    squares += value * value;
    if (std::abs(value) > 2.0) ++beyond_two;
  }
  EXPECT_NEAR(sum / 10000, 0.0, 0.04);
  EXPECT_NEAR(squares / 10000, 1.0, 0.06);
  EXPECT_NEAR(beyond_two, 455, 100);
}

}  // namespace
}  // namespace voxlist::simulation
