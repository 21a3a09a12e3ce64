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

}  // namespace voxlist::matching
