// As in a Release build, whatever this build is.
#undef VOXLIST_CHECKS
#define VOXLIST_CHECKS 0

#include <gtest/gtest.h>

#include "voxlist/system/check.h"

namespace voxlist {
namespace {

TEST(CheckOff, DoesNotEvaluateItsCondition) {
  int evaluated = 0;
  VOXLIST_CHECK(++evaluated == 0, "never looked at");
  EXPECT_EQ(evaluated, 0);
}

}  // namespace
}  // namespace voxlist
