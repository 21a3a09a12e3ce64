#include "voxlist/matching/motion/odometry_check.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace voxlist::matching {
namespace {

constexpr std::int64_t kSecond_us = 1'000'000;

UncertainPose sure(const Pose2& pose, double along_m = 0.005) {
  return {pose, Eigen::Vector3d(along_m * along_m, 2.5e-5, 1e-6).asDiagonal()};
}

struct Step {
  Pose2 robot, odometry;
};

// The last error of a drive of such steps, a second each.
std::optional<OdometryError> drive(const std::vector<Step>& steps, double along_m = 0.005) {
  OdometryCheck check;
  Pose2 pose, odometry{7.0, -3.0, 2.0};
  auto last = check.add(0, sure(pose, along_m), odometry);
  std::int64_t utime_us = 0;
  for (const Step& step : steps) {
    pose = pose * step.robot;
    odometry = odometry * step.odometry;
    last = check.add(utime_us += kSecond_us, sure(pose, along_m), odometry);
  }
  return last;
}

bool disagrees(const std::optional<OdometryError>& error) { return error && error->disagrees(); }

const Step kStill{{}, {}}, kSlip{{0.2, 0.0, 0.0}, {0.6, 0.0, 0.05}};

TEST(OdometryCheck, TellsAWayOfWhichWheelsHaveSlippedWhenTwoPosesHaveSeenIt) {
  EXPECT_FALSE(disagrees(drive({kStill, kSlip})));
  const auto error = drive({kStill, kSlip, kStill});
  ASSERT_TRUE(disagrees(error));
  EXPECT_NEAR(error->way_m, 0.6, 1e-9);
  EXPECT_NEAR(error->distance_m, 0.4, 1e-9);
  EXPECT_NEAR(error->turn_rad, 0.05, 1e-9);
  EXPECT_GE(error->seconds, 1.0);
}

TEST(OdometryCheck, DoesNotBlameOdometryForOnePoseThatIsWrong) {
  std::vector<Step> steps(12, kStill);
  steps[4].robot.x_m = 0.4;
  steps[5].robot.x_m = -0.4;
  for (std::size_t end = 1; end <= steps.size(); ++end)
    EXPECT_FALSE(disagrees(drive({steps.begin(), steps.begin() + static_cast<long>(end)}))) << end;
}

TEST(OdometryCheck, StandsWheelsThatAreAFewPerCentOff) {
  for (const std::size_t steps : {3U, 5U, 20U}) {
    const Step drives{{0.6, 0.0, 0.1}, {0.63, 0.0, 0.105}}, stands{{}, {0.001, 0.0, 0.0005}};
    for (const Step& step : {drives, stands}) {
      const auto error = drive(std::vector<Step>(steps, step));
      ASSERT_TRUE(error) << steps;
      EXPECT_FALSE(error->disagrees()) << steps;
    }
  }
}

TEST(OdometryCheck, SeesOverManyStepsWhatOneDoesNotShow) {
  const Step step{{0.3, 0.0, 0.0}, {0.4, 0.0, 0.0}};
  EXPECT_FALSE(disagrees(drive({kStill, step, kStill})));
  const auto error = drive(std::vector<Step>(12, step));
  ASSERT_TRUE(disagrees(error));
  EXPECT_GT(error->seconds, 2.0);
}

TEST(OdometryCheck, DoesNotBlameOdometryAlongACorridor) {
  const Step slip{{0.2, 0.0, 0.0}, {0.6, 0.0, 0.0}};
  EXPECT_TRUE(disagrees(drive({kStill, slip, kStill})));
  const auto error = drive({kStill, slip, kStill}, 0.3);
  ASSERT_TRUE(error);
  EXPECT_LT(error->sigmas, 2.0);
}

TEST(OdometryCheck, ForgetsASlipAfterTenSeconds) {
  for (const std::size_t after : {1U, 8U, 12U}) {
    std::vector<Step> steps = {kStill, kSlip};
    steps.insert(steps.end(), after, kStill);
    EXPECT_EQ(disagrees(drive(steps)), after < 10) << after;
  }
}

TEST(OdometryCheck, SaysNothingWithoutOdometryOrWhereTheRobotWasFoundAnew) {
  OdometryCheck check;
  std::int64_t utime_us = 0;
  const auto add = [&](const std::optional<Pose2>& T_odom_base) {
    return check.add(utime_us += kSecond_us, sure({}), T_odom_base);
  };
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(add(Pose2{}));
  EXPECT_TRUE(add(Pose2{}));
  EXPECT_FALSE(add(std::nullopt));
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(add(Pose2{5.0, 0.0, 0.0}));
  EXPECT_TRUE(add(Pose2{5.0, 0.0, 0.0}));
  check.clear();
  EXPECT_FALSE(add(Pose2{9.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace voxlist::matching
