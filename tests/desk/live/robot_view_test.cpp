#include "services/voxlist/live/robot_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/obstacles_t.hpp>

namespace voxlist::desk {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

localisation_t localisation(std::int32_t state, const std::vector<double>& probabilities) {
  localisation_t message{};
  message.utime = 1'700'000'000'000'000;
  message.state = state;
  for (const double probability : probabilities) {
    pose_mode_t mode{};
    mode.pose[0] = 1.0;
    // 0.1 m along, 0.02 m across, turned by 45 deg; 0.01 rad.
    mode.covariance[0] = mode.covariance[4] = 0.0052;
    mode.covariance[1] = mode.covariance[3] = 0.0048;
    mode.covariance[8] = 1e-4;
    mode.probability = probability;
    message.modes.push_back(mode);
  }
  return message;
}

TEST(RobotView, WaitsUntilSomethingIsHeard) {
  const RobotView robot;
  EXPECT_FALSE(robot.seen());
  EXPECT_THAT(robot.lines(0.0).at(0), StartsWith("waiting for LOCALISATION"));
}

TEST(RobotView, ShowsPoseMapAndObstacle) {
  RobotView robot;
  robot.take(localisation(localisation_t::STATE_TRACKING, {0.99}), 0.0);
  keyframe_t keyframe{};
  keyframe.index = 6;
  robot.take(keyframe, 0.0);
  obstacles_t obstacles{};
  obstacles.nearest_m = {{3.0F, 1.5F}, {}, {}};
  robot.take(obstacles, 0.0);
  ASSERT_THAT(robot.lines(1.0), SizeIs(1));
  EXPECT_EQ(
      robot.lines(1.0)[0],
      "    0 s  TRACKING   x    1.00 m  y    0.00 m  yaw    0.0 deg  1 sigma 0.100 m 0.57 deg  "
      "map    7 keyframes  "
      "nearest obstacle 1.50 m");
  EXPECT_EQ(robot.summary(), "1 clouds, 1 placed, map of 7 keyframes");
}

TEST(RobotView, SaysHowOldItIsInsteadOfTrackingForEver) {
  RobotView robot;
  robot.take(localisation(localisation_t::STATE_TRACKING, {0.99}), 10.0);
  EXPECT_THAT(robot.lines(13.0).at(0), HasSubstr("TRACKING   x"));
  EXPECT_THAT(robot.lines(22.0).at(0),
              StartsWith("no LOCALISATION for 12 s; the last was TRACKING at x    1.00 m"));
}

TEST(RobotView, ForgetsAnObstacleThatIsOld) {
  RobotView robot;
  obstacles_t obstacles{};
  obstacles.nearest_m = {{}, {1.5F}, {}};
  robot.take(obstacles, 0.0);
  robot.take(localisation(localisation_t::STATE_LOST, {}), 10.0);
  EXPECT_THAT(robot.lines(10.0).at(0), Not(HasSubstr("obstacle")));
}

TEST(RobotView, ShowsCandidatesWithTheirProbabilitiesWhileAmbiguous) {
  RobotView robot;
  robot.take(localisation(localisation_t::STATE_AMBIGUOUS, {0.6, 0.3}), 0.0);
  const auto lines = robot.lines(0.0);
  ASSERT_THAT(lines, SizeIs(3));
  EXPECT_THAT(lines[0], Not(HasSubstr("x ")));
  EXPECT_EQ(lines[1],
            "  candidate 1: x    1.00 m  y    0.00 m  yaw    0.0 deg  1 sigma 0.100 m 0.57 deg  "
            "probability 0.60");
  EXPECT_THAT(lines[2], HasSubstr("probability 0.30"));
}

TEST(RobotView, StandsStatesThatDoNotExist) {
  RobotView robot;
  robot.take(localisation(77, {}), 0.0);
  EXPECT_THAT(robot.lines(0.0).at(0), HasSubstr("?"));
}

}  // namespace
}  // namespace voxlist::desk
