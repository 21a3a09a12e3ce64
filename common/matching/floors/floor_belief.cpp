#include "voxlist/matching/floors/floor_belief.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "voxlist/geometry/elementary.h"

namespace voxlist::matching {
namespace {

// A robot that sees where it is from scan to scan was carried to another floor with these odds. A
// judgement: far more often than lifts are, and so rarely that floors that are the same leave a
// drive sure.
constexpr double kRare = 1e-3;
// One that saw nothing of its surroundings for as long as a lift takes (s), and has moved no
// farther (m): as likely as not.
constexpr double kLift_s = 5.0, kStood_m = 1.0, kLikely = 1.0;
// Views of one floor lie this near to each other (m), other floors are farther away.
constexpr double kSame_m = 0.5;
// A scan after the first counts this much once the robot has moved that far (m), and in proportion
// before, as where a lost robot's hypotheses are followed (hypotheses.cpp).
constexpr double kNext = 0.5, kNextDistance_m = 0.5;

}  // namespace

void FloorBelief::weigh(std::int64_t utime_us, bool is_boxed, const FloorView& here,
                        const std::vector<FloorView>& others) {
  const Eigen::Vector3d at = here.T_map_base.translation();
  const double lift = elementary::log(odds_of_lift(utime_us, at) /
                                      static_cast<double>(std::max<std::size_t>(1, others.size())));
  const double moved_m = sees_ ? (at - seen_->at).norm() : kNextDistance_m;
  const double weight = (sees_ ? kNext : 1.0) * std::min(1.0, moved_m / kNextDistance_m);
  std::vector<Rival> now;
  for (const FloorView& other : others) {
    const double odds = is_boxed ? 0.0 : log_odds_between(other, here);
    now.push_back({other, std::max(past(other) + weight * odds, lift + odds)});
  }
  rivals_ = std::move(now);
  sees_ = !is_boxed;
  if (sees_) seen_ = {utime_us, at};
}

std::vector<double> FloorBelief::probabilities() const {
  std::vector<double> probabilities{1.0};
  for (const Rival& rival : rivals_) probabilities.push_back(elementary::exp(rival.log_odds));
  const double sum = std::accumulate(probabilities.begin(), probabilities.end(), 0.0);
  for (double& p : probabilities) p /= sum;
  return probabilities;
}

double FloorBelief::odds_of_lift(std::int64_t utime_us, const Eigen::Vector3d& at) const {
  const bool may_ride = seen_ && utime_us - seen_->utime_us >= std::llround(1e6 * kLift_s) &&
                        (at - seen_->at).norm() < kStood_m;
  return may_ride ? kLikely : kRare;
}

double FloorBelief::past(const FloorView& floor) const {
  for (const Rival& rival : rivals_)
    if (std::abs(rival.view.T_map_base.translation().z() - floor.T_map_base.translation().z()) <
        kSame_m)
      return rival.log_odds;
  return -std::numeric_limits<double>::infinity();
}

}  // namespace voxlist::matching
