#include "voxlist/matching/localisation/hypotheses.h"

#include <algorithm>
#include <cmath>

namespace voxlist::matching {
namespace {

// Poses nearer than this are one place; so is a place found again after a motion.
constexpr double kSamePlace_m = 0.4, kSamePlace_rad = 0.15;
// Most places that are followed.
constexpr std::size_t kMostPlaces = 40;
// Less probable than the best by this factor's logarithm: given up.
constexpr double kHopeless = 30.0;
// A scan after the first counts this much once the robot has moved that far (m), and in proportion
// before: neighbouring scans see the same things, and err together. Most of all they do so in a
// building that the map is not of.
constexpr ScanWeight kNext{0.5, 0.15};
constexpr double kNextDistance_m = 0.5;

bool same_place(const Pose2& a, const Pose2& b) {
  return distance_m(a, b) < kSamePlace_m && turn_rad(a, b) < kSamePlace_rad;
}

}  // namespace

double rival_support(const PoseMode& candidate, const std::vector<PoseMode>& all, double unseen) {
  double best = unseen * candidate.even_support;
  for (const PoseMode& other : all)
    if (!same_place(other.T_map_base, candidate.T_map_base))
      best = std::max(best, other.even_support);
  return best;
}

void Hypotheses::clear() { *this = {}; }

void Hypotheses::move(const Pose2& motion) {
  for (Place& place : places_) place.mode.T_map_base = place.mode.T_map_base * motion;
  moved_m_ += distance_m({}, motion);
}

std::vector<PoseMode> Hypotheses::places() const {
  std::vector<PoseMode> modes;
  for (const Place& place : places_) modes.push_back(place.mode);
  return modes;
}

Odds Hypotheses::past(const Pose2& pose) const {
  const auto found = std::find_if(places_.begin(), places_.end(), [&](const Place& place) {
    return same_place(place.mode.T_map_base, pose);
  });
  return found == places_.end() ? unlisted_ : found->odds;
}

void Hypotheses::weigh(const std::vector<PoseMode>& candidates, double unseen) {
  if (empty()) clear();
  const double share = std::min(1.0, moved_m_ / kNextDistance_m);
  const ScanWeight weight =
      empty() ? ScanWeight{} : ScanWeight{share * kNext.place, share * kNext.found};
  moved_m_ = 0.0;
  std::vector<Place> now;
  PlaceSupport worst{1.0, 1.0}, best;
  for (const PoseMode& candidate : candidates) {
    const PlaceSupport supported{candidate.support, candidate.even_support};
    Place place{candidate, past(candidate.T_map_base)};
    place.odds += odds_of(supported, rival_support(candidate, candidates, unseen), weight);
    now.push_back(place);
    worst = {std::min(worst.near, supported.near), std::min(worst.even, supported.even)};
    best = {std::max(best.near, supported.near), std::max(best.even, supported.even)};
  }
  // At best as good as the worst that was listed, and as what was not looked for.
  if (!candidates.empty())
    unlisted_ += odds_of(
        {std::min(worst.near, unseen * best.near), std::min(worst.even, unseen * best.even)},
        best.even, weight);
  std::stable_sort(now.begin(), now.end(),
                   [](const Place& a, const Place& b) { return a.odds.place > b.odds.place; });
  places_.clear();
  for (const Place& place : now) {
    const bool known = std::any_of(places_.begin(), places_.end(), [&](const Place& other) {
      return same_place(other.mode.T_map_base, place.mode.T_map_base);
    });
    const bool hopeless = place.odds.place < now.front().odds.place - kHopeless;
    if (!known && !hopeless && places_.size() < kMostPlaces) places_.push_back(place);
  }
}

std::vector<PoseMode> Hypotheses::modes() const {
  std::vector<Odds> odds;
  for (const Place& place : places_) odds.push_back(place.odds);
  const std::vector<double> probability = probabilities(odds);
  std::vector<PoseMode> modes = places();
  for (std::size_t i = 0; i < modes.size(); ++i) modes[i].probability = probability[i];
  return modes;
}

}  // namespace voxlist::matching
