#include "voxlist/matching/localisation/hypotheses.h"

#include <algorithm>

namespace voxlist::matching {
namespace {

// Poses nearer than this (m, rad) are one hypothesis, as is one that is found again after a motion:
// more than the 0.3 m and 0.12 rad that it is searched in (lost_search.cpp), so that it is known
// again. Much larger: two alike rooms beside each other become one.
constexpr double kSame_m = 0.4, kSame_rad = 0.15;
// Most hypotheses that are followed, each by a search of 1 to 2 ms when the search of the whole map
// does not list it. Above the 32 rooms that hotel_floor has alike; with fewer, the right one may be
// dropped where all are alike.
constexpr std::size_t kMostHypotheses = 40;
// A hypothesis that is less probable than the best by this factor's natural logarithm is given up:
// after three scans in which it has 0.08 less support (0.90 beside 0.98). Chosen by judgement, to
// save time. Far lower: one odd scan drops the right hypothesis.
constexpr double kHopeless = 30.0;
// A scan after the first counts this much once the robot has moved that far (m), and in proportion
// before: neighbouring scans see the same things, and err together. Most of all they do so in a
// building that the map is not of. Chosen by judgement. More: sure sooner, and sure of wrong poses
// in foreign buildings; less: more scans until a robot knows where it is.
constexpr ScanWeight kNext{0.5, 0.15};
constexpr double kNextDistance_m = 0.5;

// Scans say no more than this (log odds, 1 in 1000) against all poses of the map: a robot that is
// elsewhere may drive into it. Without it, a robot that came back to a map after 50 scans elsewhere
// was LOST in it for 20 more. Higher: nearer to believing each scan by itself.
constexpr double kLeastAtAll = -6.9;

bool same_pose(const PoseMode& a, const Pose2& b) {
  return distance_m(a.T_map_base, b) < kSame_m && turn_rad(a.T_map_base, b) < kSame_rad;
}

// What a scan says of a pose that it did not list: at best as good as the worst that it listed, and
// as what was not looked for.
LogOdds odds_of_unlisted(const std::vector<PoseMode>& candidates, double unseen,
                         const ScanWeight& weight) {
  PoseSupport worst{1.0, 1.0}, best;
  for (const PoseMode& candidate : candidates) {
    const PoseSupport& support = candidate.support;
    worst = {std::min(worst.near, support.near), std::min(worst.even, support.even)};
    best = {std::max(best.near, support.near), std::max(best.even, support.even)};
  }
  return log_odds_of(
      {std::min(worst.near, unseen * best.near), std::min(worst.even, unseen * best.even)},
      best.even, weight);
}

}  // namespace

double rival_support(const PoseMode& candidate, const std::vector<PoseMode>& all, double unseen) {
  double best = unseen * candidate.support.even;
  for (const PoseMode& other : all)
    if (!same_pose(other, candidate.T_map_base)) best = std::max(best, other.support.even);
  return best;
}

void Hypotheses::clear() {
  hypotheses_.clear();
  unlisted_ = {0.0, -doubt_};
  moved_m_ = 0.0;
}

void Hypotheses::move(const Pose2& motion) {
  for (Hypothesis& hypothesis : hypotheses_)
    hypothesis.mode.T_map_base = hypothesis.mode.T_map_base * motion;
  moved_m_ += distance_m({}, motion);
}

std::vector<PoseMode> Hypotheses::poses() const {
  std::vector<PoseMode> modes;
  for (const Hypothesis& hypothesis : hypotheses_) modes.push_back(hypothesis.mode);
  return modes;
}

void Hypotheses::update(const std::vector<PoseMode>& candidates, double unseen) {
  if (empty()) clear();
  const ScanWeight weight = weight_of_scan();
  moved_m_ = 0.0;
  std::vector<Hypothesis> now;
  for (const PoseMode& candidate : candidates) {
    Hypothesis hypothesis{candidate, past(candidate.T_map_base)};
    hypothesis.odds +=
        log_odds_of(candidate.support, rival_support(candidate, candidates, unseen), weight);
    hypothesis.odds.at_all = std::max(hypothesis.odds.at_all, kLeastAtAll);
    now.push_back(hypothesis);
  }
  if (!candidates.empty()) unlisted_ += odds_of_unlisted(candidates, unseen, weight);
  unlisted_.at_all = std::max(unlisted_.at_all, kLeastAtAll);
  std::stable_sort(now.begin(), now.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.odds.among > b.odds.among;
  });
  keep_distinct(now);
}

std::vector<PoseMode> Hypotheses::modes() const {
  std::vector<LogOdds> odds;
  for (const Hypothesis& hypothesis : hypotheses_) odds.push_back(hypothesis.odds);
  const std::vector<double> probability = probabilities(odds);
  std::vector<PoseMode> modes = poses();
  for (std::size_t i = 0; i < modes.size(); ++i) modes[i].probability = probability[i];
  return modes;
}

ScanWeight Hypotheses::weight_of_scan() const {
  if (empty()) return {};
  const double share = std::min(1.0, moved_m_ / kNextDistance_m);
  return {share * kNext.among, share * kNext.at_all};
}

// What the scans so far said of a pose.
LogOdds Hypotheses::past(const Pose2& pose) const {
  const auto found =
      std::find_if(hypotheses_.begin(), hypotheses_.end(),
                   [&](const Hypothesis& hypothesis) { return same_pose(hypothesis.mode, pose); });
  return found == hypotheses_.end() ? unlisted_ : found->odds;
}

void Hypotheses::keep_distinct(const std::vector<Hypothesis>& sorted) {
  hypotheses_.clear();
  for (const Hypothesis& candidate : sorted) {
    const bool known = std::any_of(
        hypotheses_.begin(), hypotheses_.end(),
        [&](const Hypothesis& kept) { return same_pose(kept.mode, candidate.mode.T_map_base); });
    const bool hopeless = candidate.odds.among < sorted.front().odds.among - kHopeless;
    if (!known && !hopeless && hypotheses_.size() < kMostHypotheses)
      hypotheses_.push_back(candidate);
  }
}

}  // namespace voxlist::matching
