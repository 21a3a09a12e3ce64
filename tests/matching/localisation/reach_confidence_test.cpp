// How what odometry says weighs against what a scan says.
#include "voxlist/matching/localisation/reach_confidence.h"

#include <gtest/gtest.h>

#include <cmath>

namespace voxlist::matching {
namespace {

constexpr double kInReach = 0.995;

// Sure to so much (m, and a tenth of it in rad) of the robot at the origin.
UncertainPose expected_within(double sigma) {
  return {{}, Eigen::Vector3d(sigma * sigma, sigma * sigma, 0.01 * sigma * sigma).asDiagonal()};
}

MatchMode place(double x_m, double support) {
  MatchMode mode;
  mode.pose = {x_m, 0.0, 0.0};
  mode.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  mode.evidence.points = 500;
  mode.evidence.hits = static_cast<int>(300.0 * support);
  mode.evidence.misses = 300 - mode.evidence.hits;
  mode.support = support;
  mode.overlap_ratio = 0.6;
  return mode;
}

double sure_of(const MatchMode& mode, const UncertainPose& predicted) {
  std::vector<MatchMode> modes{mode};
  return rank_in_reach(predicted, PoseWindow{{}, 0.5, 0.5, 0.1}, kInReach, modes).front();
}

double log_odds(double p) { return std::log(p / (1.0 - p)); }

TEST(ReachConfidence, DoubtsAPlaceFarFromWhereASureOdometryHasTheRobot) {
  const double there = sure_of(place(0.3, 0.7), expected_within(0.015));
  EXPECT_LT(there, sure_of(place(0.02, 0.7), expected_within(0.015)) - 0.01);
  EXPECT_LT(there, sure_of(place(0.3, 0.7), expected_within(0.15)) - 0.01);
}

TEST(ReachConfidence, TakesNoPlaceForSurerBecauseItWasExpected) {
  EXPECT_NEAR(sure_of(place(0.0, 0.7), expected_within(0.015)),
              sure_of(place(0.1, 0.7), expected_within(0.15)), 1e-6);
}

// Wheels slip now and then: however far, that costs a place no more than the odds of one in twenty.
TEST(ReachConfidence, LetsWhatFitsWellWinOverWheelsThatSlipped) {
  const double expected = sure_of(place(0.0, 0.97), expected_within(0.015)),
               slipped = sure_of(place(0.45, 0.97), expected_within(0.015));
  EXPECT_GT(slipped, 0.99);
  EXPECT_NEAR(log_odds(expected) - log_odds(slipped), std::log(20.0), 0.1);
}

}  // namespace
}  // namespace voxlist::matching
