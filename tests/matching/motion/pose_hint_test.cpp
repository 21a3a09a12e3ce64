#include "voxlist/matching/motion/pose_hint.h"

#include <gtest/gtest.h>

namespace voxlist::matching {
namespace {

const UncertainPose kThere{{3.0, 2.0, 0.0}, Eigen::Vector3d(0.25, 0.25, 0.07).asDiagonal()};

TEST(PoseHint, MovesAsOdometryDoes) {
  PoseHint hint;
  hint.take(kThere);
  EXPECT_EQ(hint.next(Pose2{10.0, 0.0, 0.0})->pose, kThere.pose);
  EXPECT_NEAR(hint.next(Pose2{11.0, 0.5, 0.0})->pose.x_m, 4.0, 1e-9);
  const auto last = hint.next(Pose2{11.0, 1.5, 0.0});
  EXPECT_NEAR(last->pose.x_m, 4.0, 1e-9);
  EXPECT_NEAR(last->pose.y_m, 3.5, 1e-9);
  EXPECT_EQ(last->covariance, kThere.covariance);
}

TEST(PoseHint, IsWorthNothingAfterThreeScansOrWhenItIsForgotten) {
  PoseHint hint;
  EXPECT_FALSE(hint.next(std::nullopt));
  hint.take(kThere);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(hint.next(std::nullopt));
  EXPECT_FALSE(hint.next(std::nullopt));
  hint.take(kThere);
  hint.forget();
  EXPECT_FALSE(hint.next(std::nullopt));
}

}  // namespace
}  // namespace voxlist::matching
