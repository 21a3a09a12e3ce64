#include "voxlist/matching/motion/motion_guess.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "voxlist/matching/motion/match_scatter.h"
#include "voxlist/matching/motion/pose_fusion.h"

namespace voxlist::matching {
namespace {

const MotionLimits kLimits{2.0, 1.5};
// Half a metre a second on a wide arc.
const Pose2 kStep{0.5, 0.0, 0.02};
constexpr double kMatch_m = 0.003, kMatch_rad = 0.001;

UncertainPose known(const Pose2& pose) {
  return {pose, Eigen::Vector3d(kMatch_m * kMatch_m, kMatch_m * kMatch_m, kMatch_rad * kMatch_rad)
                    .asDiagonal()};
}

// A drive on the arc that no odometry measures.
struct Drive {
  MotionGuess guess{kLimits};
  MatchScatter scatter;
  TrackedPose track{known({})};
  Pose2 truth;

  void step(const Pose2& way, double off_m = 0.0, double dt_s = 1.0) {
    truth = truth * way;
    const TrackedPose before = track;
    guess.follow(track, dt_s);
    const UncertainPose expected = scatter.expected(track.pose());
    const UncertainPose seen = known({truth.x_m + off_m, truth.y_m, truth.yaw_rad});
    const UncertainPose vague{expected.pose, 1e6 * expected.covariance};
    scatter.correct(track, fused(expected, vague, seen, Eigen::Matrix3d::Zero()));
    guess.learn(before, expected.pose, track, dt_s, true);
  }
  double error_m() const { return distance_m(track.pose().pose, truth); }
};

TEST(MotionGuess, ExpectsTheVelocityToGoOn) {
  Drive drive;
  for (int i = 0; i < 20; ++i) drive.step(kStep);
  TrackedPose later = drive.track;
  drive.guess.follow(later, 2.0);
  EXPECT_LT(distance_m(later.pose().pose, drive.truth * kStep * kStep), 0.02);
  // Its velocity may change by 0.1 m/s each second, so it is off by twice that after two of them.
  EXPECT_NEAR(std::sqrt(later.pose().covariance(0, 0)), 0.4, 0.1);
}

TEST(MotionGuess, IsAsVagueAsTheFastestRobotAfterALongGap) {
  Drive drive;
  for (int i = 0; i < 20; ++i) drive.step(kStep);
  TrackedPose later = drive.track;
  drive.guess.follow(later, 12.0);
  EXPECT_LT(distance_m(later.pose().pose, drive.truth), 0.01);
  EXPECT_NEAR(std::sqrt(later.pose().covariance(0, 0)), 12.0 * kLimits.speed_mps / 3.0, 0.1);
}

TEST(MotionGuess, FollowsARobotThatStops) {
  Drive drive;
  for (int i = 0; i < 20; ++i) drive.step(kStep);
  for (int i = 0; i < 3; ++i) {
    drive.step({});
    EXPECT_LT(drive.error_m(), 0.02) << i;
  }
}

// A mast that sways moves the laser, not the robot: each match claims to be exact to millimetres.
TEST(MotionGuess, IsAsUnsureAsASteadyMotionShowsMatchesToBe) {
  constexpr double kSway_m = 0.1;
  std::mt19937 random(7);
  std::normal_distribution<double> sway_m(0.0, kSway_m);
  Drive drive;
  double squares = 0.0;
  for (int i = 0; i < 200; ++i) {
    drive.step(kStep, sway_m(random));
    if (i >= 100) squares += mahalanobis2(drive.truth, drive.track.pose());
  }
  EXPECT_NEAR(std::sqrt(drive.scatter.variances().x()), kSway_m, 0.05);
  EXPECT_LT(squares / 100, 6.0);
}

}  // namespace
}  // namespace voxlist::matching
