#include "voxlist/mapping/pieces/carried_scans.h"

#include <gtest/gtest.h>

#include <vector>

namespace voxlist::mapping {
namespace {

TEST(CarriedScans, GoWithTheKeyframeNearestInTimeAndThenInPlace) {
  const auto at = [](std::int64_t utime_us, double x_m) {
    return StampedPose3{utime_us, to_pose3({x_m, 0.0, 0.0})};
  };
  const std::vector<StampedPose3> before{at(0, 0.0), at(10, 5.0), at(10, 50.0)};
  std::vector<StampedPose3> after{at(0, 0.0), at(10, 6.0), at(10, 70.0)};
  std::vector<StampedPose3> scans{at(4, 2.0), at(6, 3.0), at(11, 49.0)};
  carry_scans(scans, before, after);
  const double x_m[] = {2.0, 4.0, 69.0};
  for (std::size_t i = 0; i < scans.size(); ++i)
    EXPECT_NEAR(scans[i].pose.translation().x(), x_m[i], 1e-9);
}

}  // namespace
}  // namespace voxlist::mapping
