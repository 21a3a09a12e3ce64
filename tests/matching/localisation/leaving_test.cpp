#include "voxlist/matching/localisation/leaving.h"

#include <gtest/gtest.h>

namespace voxlist::matching {
namespace {

constexpr double kSpeed_mps = 2.0;

ScanMoment moment(double seconds, std::optional<double> wheels_m = std::nullopt) {
  ScanMoment moment{static_cast<std::int64_t>(seconds * 1e6), std::nullopt};
  if (wheels_m) moment.T_odom_base = Pose2{*wheels_m, 0.0, 0.0};
  return moment;
}

TEST(Leaving, TakesAsLongAsTheRobotNeedsForTenMetres) {
  EXPECT_TRUE(is_near(moment(1.0), moment(5.9), {}, kSpeed_mps));
  EXPECT_FALSE(is_near(moment(1.0), moment(6.1), {}, kSpeed_mps));
}

TEST(Leaving, TakesTenMetresOfOdometryWhereTheRobotIsFollowed) {
  Localisation found;
  EXPECT_TRUE(is_near(moment(0.0, 0.0), moment(60.0, 9.0), found, kSpeed_mps));
  EXPECT_FALSE(is_near(moment(0.0, 0.0), moment(60.0, 11.0), found, kSpeed_mps));
  found.searched_whole_map = true;
  EXPECT_FALSE(is_near(moment(0.0, 0.0), moment(60.0, 9.0), found, kSpeed_mps));
}

TEST(Leaving, IsNotWhereOnlyOneDirectionIsOpen) {
  Localisation found;
  EXPECT_FALSE(is_followed(found));
  found.confidence = 0.999;
  found.modes.resize(1);
  found.modes[0].covariance(0, 0) = 2.0 * 2.0;
  EXPECT_TRUE(is_followed(found));
  found.modes[0].covariance(0, 0) = 4.0 * 4.0;
  EXPECT_FALSE(is_followed(found));
}

}  // namespace
}  // namespace voxlist::matching
