#include "voxlist/matching/localisation/reach_match.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "voxlist/matching/localisation/reach_confidence.h"

namespace voxlist::matching {
namespace {

// A window reaches so many standard deviations of the prediction, and at least so far (m, rad).
constexpr double kWindowSigmas = 3.0, kLeastWindow_m = 0.3, kLeastWindow_rad = 0.05;
// A prediction that is vaguer (m, to each side) is looked for in the whole map, which is quicker by
// then.
constexpr double kWidest_m = 5.0;
// Then the robot is at one of the places that the search finds with this probability at most: a map
// that the robot makes may end before its reach does. A judgement.
constexpr double kInMap = 0.5;
// A prediction that is vaguer (m, as a standard deviation) tells nothing, as after a minute between
// stations: there the map alone decides, and with even odds 28 of 66 stations are placed.
constexpr double kVaguest_m = 20.0;

// Two places farther apart than this (m, rad) are different ones, for rays end elsewhere. Of 8
// robots that passed for being where they were expected, one had been carried 0.25 m along a
// corridor.
constexpr double kOther_m = 0.15, kOther_rad = 0.05;
// A robot that was carried is at one given place of the map with this probability. A judgement: a
// place that explains a scan as well as the expected one, as an alike room does, is no rival of it.
constexpr double kThere = 0.01;

bool is_other(const Pose2& a, const Pose2& b) {
  return distance_m(a, b) > kOther_m || turn_rad(a, b) > kOther_rad;
}

// Expected nowhere: the scan alone says where it was taken.
UncertainPose expected_nowhere() {
  constexpr double kVague = 1e6;  // m and rad
  return {{}, kVague * kVague * Eigen::Matrix3d::Identity()};
}

// The places that a match lists, with their probabilities.
ReachMatch ranked(Match match, const UncertainPose& predicted,
                  const std::optional<PoseWindow>& window, double in_reach, Rivals rivals) {
  ReachMatch result{std::move(match), {}};
  result.probabilities = rank_in_reach(predicted, window, in_reach, result.match.modes,
                                       Rivals::kAnywhere == rivals ? result.match.unseen : 0.0);
  return result;
}

}  // namespace

PoseWindow window_about(const UncertainPose& pose) {
  const auto half = [&](int i, double least) {
    return least + kWindowSigmas * std::sqrt(pose.covariance(i, i));
  };
  return {pose.pose, half(0, kLeastWindow_m), half(1, kLeastWindow_m),
          std::min(half(2, kLeastWindow_rad), std::numbers::pi)};
}

ReachMatch match_in_reach(Matcher& matcher, const PreparedScan& scan,
                          const UncertainPose& predicted, double in_reach, Rivals rivals) {
  std::optional<PoseWindow> window = window_about(predicted);
  if (std::max(window->half_x_m, window->half_y_m) > kWidest_m) window.reset();
  const bool beyond =
      !window && rivals == Rivals::kInReach && worst_sigma_m(predicted.covariance) < kVaguest_m;
  if (beyond) in_reach = std::min(in_reach, kInMap);
  ReachMatch result =
      ranked(matcher.track(scan, window, predicted), predicted, window, in_reach, rivals);
  if (beyond && result.best() >= kSureInReach)
    result = ranked(matcher.track_rivals(scan, predicted), predicted, window, in_reach, rivals);
  return result;
}

void weigh_elsewhere(Matcher& matcher, const PreparedScan& scan, double in_reach,
                     ReachMatch& reach) {
  const MatchMode& here = reach.match.modes.front();
  double odds = 0.0;
  for (const MatchMode& there : matcher.track(scan, std::nullopt, expected_nowhere()).modes)
    if (is_other(here.pose, there.pose)) odds = std::max(odds, odds_between(there, here));
  odds *= kThere * (1.0 - in_reach) / in_reach;
  const double left = 1.0 / (1.0 + odds * reach.best());
  for (double& p : reach.probabilities) p *= left;
}

}  // namespace voxlist::matching
