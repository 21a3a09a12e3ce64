#include "voxlist/matching/localisation/reach_confidence.h"

#include <algorithm>
#include <cmath>

#include "voxlist/geometry/elementary.h"
#include "voxlist/matching/engines/student.h"

namespace voxlist::matching {
namespace {

// Places are compared by powers of what they leave unexplained, as where the whole map is searched
// (confidence.cpp).
constexpr double kPlacePower = 12.0, kSlack = 0.05;

// Modes that are nearer to each other than this (m, rad) are one place: its pose is less sure, not
// its probability. A judgement: about a robot's size.
constexpr double kSame_m = 0.3, kSame_rad = 0.1;

// Fitted by tests/bench/fits/fit_places.py: whether the best place in reach is right.
constexpr double kBias = -4.34, kSupport = -4.42, kKnown = -16.56, kSupportKnown = -0.77,
                 kRival = 13.77, kOverlap = 9.19;
// A place that is not listed may have this share of the best one's support, or more where the
// search says so.
constexpr double kUnseen = 0.9;

double unexplained(double support) {
  return elementary::log(1.0 - std::clamp(support, 0.0, 1.0) + kSlack);
}

// Odometry, or a velocity, is altogether wrong with this probability: wheels slip. A judgement.
constexpr double kAstray = 0.05;
// Of Student's distribution of three coordinates, no error at all (Gamma(3.5) / (4 pi)^1.5).
constexpr double kLogPeak = -2.5956;

// How much rarer a right place is so far from where it was expected than a wrong one, which may be
// anywhere in the window; its logarithm. 0: not rarer, for where it was expected, chance puts wrong
// ones too, or the prediction was too vague for a window and says nothing.
double surprise(const UncertainPose& predicted, const std::optional<PoseWindow>& window,
                const MatchMode& mode) {
  if (!window) return 0.0;
  const UncertainPose expected{predicted.pose, predicted.covariance + mode.covariance};
  const double log_right = kLogPeak - 0.5 * elementary::log(expected.covariance.determinant()) +
                           log_student(mahalanobis2(mode.pose, expected));
  const double log_wrong =
      -elementary::log(8.0 * window->half_x_m * window->half_y_m * window->half_yaw_rad);
  const double ratio = elementary::exp(std::min(0.0, log_right - log_wrong));
  return elementary::log(kAstray + (1.0 - kAstray) * ratio);
}

double share(int part, int all) { return static_cast<double>(part) / std::max(all, 1); }

// Logarithm of the odds that the first mode is right, if it is as often as not.
double log_odds(const std::vector<MatchMode>& modes, double unseen) {
  const MatchMode& best = modes.front();
  const double here = unexplained(best.support);
  const double known = share(best.evidence.hits + best.evidence.misses, best.evidence.points);
  double rival = std::max(kUnseen, unseen) * best.support;
  if (modes.size() > 1) rival = std::max(rival, modes[1].support);
  return kBias + kSupport * here + kKnown * known + kSupportKnown * here * known +
         kRival * std::max(0.0, unexplained(rival) - here) + kOverlap * best.overlap_ratio;
}

bool same_place(const Pose2& a, const Pose2& b) {
  return distance_m(a, b) < kSame_m && turn_rad(a, b) < kSame_rad;
}

Eigen::Matrix3d squared_off(const Pose2& a, const Pose2& b) {
  const Eigen::Vector3d off{a.x_m - b.x_m, a.y_m - b.y_m, wrap_angle(a.yaw_rad - b.yaw_rad)};
  return off * off.transpose();
}

// Joins sorted modes that are about at one place: as probable as all of them, and as unsure as they
// differ.
void join_places(std::vector<MatchMode>& modes, std::vector<double>& weights) {
  std::vector<MatchMode> places;
  std::vector<double> sums;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const auto at = std::find_if(places.begin(), places.end(), [&](const MatchMode& place) {
      return same_place(place.pose, modes[i].pose);
    });
    if (at == places.end()) {
      places.push_back(modes[i]);
      sums.push_back(weights[i]);
      continue;
    }
    double& sum = sums[static_cast<std::size_t>(at - places.begin())];
    const double share = weights[i] / (sum + weights[i]);
    at->covariance = (1.0 - share) * at->covariance +
                     share * (modes[i].covariance + squared_off(modes[i].pose, at->pose));
    sum += weights[i];
  }
  modes = std::move(places);
  weights = std::move(sums);
}

}  // namespace

std::vector<double> rank_in_reach(const UncertainPose& predicted,
                                  const std::optional<PoseWindow>& window, double in_reach,
                                  std::vector<MatchMode>& modes, double unseen) {
  if (modes.empty()) return {};
  const auto weight = [&](const MatchMode& mode) {
    return log_student(mahalanobis2(mode.pose, predicted)) -
           kPlacePower * unexplained(mode.support);
  };
  std::stable_sort(modes.begin(), modes.end(),
                   [&](const auto& a, const auto& b) { return weight(a) > weight(b); });
  std::vector<double> probability;
  for (const MatchMode& mode : modes)
    probability.push_back(elementary::exp(weight(mode) - weight(modes.front())));
  join_places(modes, probability);
  const double found =
      1.0 / (1.0 + (1.0 - in_reach) / in_reach *
                       elementary::exp(-log_odds(modes, unseen) -
                                       surprise(predicted, window, modes.front())));
  double sum = 0.0;
  for (const double p : probability) sum += p;
  for (double& p : probability) p *= found / sum;
  return probability;
}

double odds_between(const MatchMode& place, const MatchMode& other) {
  return elementary::exp(kPlacePower * (unexplained(other.support) - unexplained(place.support)));
}

}  // namespace voxlist::matching
