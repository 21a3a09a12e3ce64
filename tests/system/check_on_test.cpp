// As in a Debug build, whatever this build is.
#undef VOXLIST_CHECKS
#define VOXLIST_CHECKS 1

#include <gtest/gtest.h>

#include "voxlist/system/check.h"

namespace voxlist {
namespace {

int half(int even) {
  VOXLIST_CHECK(even % 2 == 0, "half() takes even numbers");
  return even / 2;
}

TEST(CheckOn, PassesWhatHolds) { EXPECT_EQ(half(8), 4); }

TEST(CheckOnDeathTest, PrintsExpressionMessageFileAndLine) {
  EXPECT_DEATH(half(7), "check_on_test.cpp:[0-9]+: half\\(\\) takes even numbers .*even % 2 == 0");
}

}  // namespace
}  // namespace voxlist
