#include "voxlist/geometry/pose.h"

#include <gtest/gtest.h>

#include <numbers>

namespace voxlist {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Pose2, ComposesLikeTheSpatialTransform) {
  const Pose2 T_a_b{1.0, -2.0, 2.5}, T_b_c{0.3, 0.7, 1.9};
  const Pose2 planar = T_a_b * T_b_c;
  const Pose2 spatial = to_pose2(to_pose3(T_a_b) * to_pose3(T_b_c));
  EXPECT_NEAR(planar.x_m, spatial.x_m, 1e-12);
  EXPECT_NEAR(planar.y_m, spatial.y_m, 1e-12);
  EXPECT_NEAR(wrap_angle(planar.yaw_rad - spatial.yaw_rad), 0.0, 1e-12);
}

TEST(Pose2, InverseUndoesThePose) {
  const Pose2 T{4.0, -1.0, -2.8};
  const Pose2 identity = T * T.inverse();
  EXPECT_NEAR(identity.x_m, 0.0, 1e-12);
  EXPECT_NEAR(identity.y_m, 0.0, 1e-12);
  EXPECT_NEAR(identity.yaw_rad, 0.0, 1e-12);
}

TEST(Pose2, MovesPointsAndKeepsTheirHeight) {
  const Eigen::Vector3d p = Pose2{1.0, 2.0, kPi / 2} * Eigen::Vector3d(3.0, 0.0, 0.5);
  EXPECT_NEAR(p.x(), 1.0, 1e-12);
  EXPECT_NEAR(p.y(), 5.0, 1e-12);
  EXPECT_EQ(p.z(), 0.5);
}

TEST(Rotation, TurnsAsEigensAngleAxisDoes) {
  for (const double angle : {-3.0, -0.4, 0.0, 1e-9, 0.7, 2.9}) {
    const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -1.2, 0.8).normalized();
    EXPECT_LT((rotation(angle, axis) - Eigen::AngleAxisd(angle, axis).toRotationMatrix()).norm(),
              1e-15)
        << angle;
  }
}

TEST(WrapAngle, StaysInTheHalfOpenCircle) {
  EXPECT_DOUBLE_EQ(wrap_angle(-kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_angle(kPi), kPi);
  EXPECT_NEAR(wrap_angle(5.0 * kPi / 2), kPi / 2, 1e-12);
}

TEST(TurnRad, MeasuresAcrossTheSeam) {
  EXPECT_NEAR(turn_rad({0, 0, kPi - 0.1}, {0, 0, -kPi + 0.1}), 0.2, 1e-12);
}

}  // namespace
}  // namespace voxlist
