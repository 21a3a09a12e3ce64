#include "services/voxlist/maps/odometry_trail.h"

#include <gtest/gtest.h>

namespace voxlist::desk {
namespace {

// A robot that drives along x, 1 m a second; the odometry frame is turned against the map's.
const Pose2 kOdometry{5.0, 3.0, 1.2};

Pose2 at_s(double seconds) { return {seconds, 0.5, 0.0}; }

std::int64_t us(double seconds) { return static_cast<std::int64_t>(seconds * 1e6); }

OdometryTrail trail(double until_s) {
  OdometryTrail trail;
  for (double t_s = 0.0; t_s <= until_s; t_s += 1.0) trail.note(us(t_s), kOdometry * at_s(t_s));
  return trail;
}

StampedPose3 placed(double seconds, double off_m = 0.0) {
  return {us(seconds), to_pose3(Pose2{off_m, 0.0, 0.0} * at_s(seconds))};
}

TEST(OdometryTrail, ExpectsAScanAWayFromTheNearestOneThatWasPlaced) {
  const auto from_before = trail(10).expect({placed(0), placed(2), placed(9, 0.3)}, us(4));
  ASSERT_TRUE(from_before);
  EXPECT_LT(distance_m(from_before->pose, at_s(4)), 1e-9);
  const auto from_after = trail(10).expect({placed(9, 0.3), placed(2), placed(0)}, us(7));
  ASSERT_TRUE(from_after);
  EXPECT_NEAR(from_after->pose.x_m, 7.3, 1e-9);
}

TEST(OdometryTrail, IsLessSureTheLongerTheWay) {
  const auto near = trail(10).expect({placed(0)}, us(1)),
             far = trail(10).expect({placed(0)}, us(8));
  ASSERT_TRUE(near && far);
  EXPECT_LT(2.0 * worst_sigma_m(near->covariance), worst_sigma_m(far->covariance));
  EXPECT_GT(worst_sigma_m(near->covariance), 0.01);
}

TEST(OdometryTrail, KnowsNothingWithoutOdometryAtBothScans) {
  EXPECT_FALSE(trail(3).expect({placed(2)}, us(4)));
  EXPECT_FALSE(trail(3).expect({placed(5)}, us(2)));
  EXPECT_FALSE(trail(3).expect({}, us(2)));
  OdometryTrail without;
  without.note(0, std::nullopt);
  EXPECT_FALSE(without.expect({placed(0)}, us(0)));
}

}  // namespace
}  // namespace voxlist::desk
