#include "voxlist/matching/localisation/lost_search.h"

#include <algorithm>

#include "voxlist/matching/engines/match_modes.h"
#include "voxlist/matching/localisation/scan_motion.h"

namespace voxlist::matching {
namespace {

// What counts as sure, and when one of the modes is probably right.
constexpr double kSure = 0.996, kLikely = 0.2;
// A place whose rivals were not seen is looked at again, unless it is as sure as that.
constexpr double kPlain = 0.99999;

// Places may be alike but for a small thing, that rays close together see; and walls far away count
// as much as near ones where rays are spread evenly.
constexpr std::size_t kMostRays = 3000;
constexpr double kNear_m = 0.05, kEven_m = 0.2;

// How far a place may be off after a motion.
constexpr double kOff_m = 0.3, kOff_rad = 0.12;

PoseMode pose_mode(const MatchMode& mode) {
  return {mode.pose, mode.covariance, mode.overlap, 0.0, 0.0, 0.0};
}

bool lists(const std::vector<PoseMode>& modes, const Pose2& pose) {
  return std::any_of(modes.begin(), modes.end(), [&](const PoseMode& mode) {
    return distance_m(mode.T_map_base, pose) < kOff_m && turn_rad(mode.T_map_base, pose) < kOff_rad;
  });
}

// A place that has moved, where the cloud fits best; where it was expected when it fits nowhere.
PoseMode found_again(Matcher& matcher, const Cloud& cloud, const PoseMode& expected) {
  const Match match =
      matcher.match(cloud, PoseWindow{expected.T_map_base, kOff_m, kOff_m, kOff_rad});
  return match.modes.empty() ? expected : pose_mode(match.modes.front());
}

struct Rays {
  explicit Rays(const Cloud& cloud)
      : near(choose_evidence_rays(cloud, kMostRays, kNear_m)),
        even(choose_evidence_rays(cloud, kMostRays, kEven_m)) {}

  std::vector<EvidenceRay> near, even;
};

void weigh(const EvidenceMap& evidence, const Rays& rays, std::vector<PoseMode>& modes) {
  for (PoseMode& mode : modes) {
    mode.support = support(evidence.at(mode.T_map_base, rays.near));
    mode.even_support = support(evidence.at(mode.T_map_base, rays.even));
  }
}

// Neither plainly right, nor is a rival listed that comes nearer than one that is not may come. A
// search that was ended early would not do better with more to look for.
bool wants_rivals(const Localisation& found) {
  if (found.modes.empty() || found.unseen >= 1.0) return false;
  const PoseMode& best =
      *std::max_element(found.modes.begin(), found.modes.end(),
                        [](const auto& a, const auto& b) { return a.support < b.support; });
  const double unseen = found.unseen * best.even_support;
  const Odds odds = odds_of({best.support, best.even_support}, unseen, {});
  return rival_support(best, found.modes, 0.0) < unseen &&
         probabilities({&odds, 1}).front() < kPlain;
}

Localisation search(const Cloud& cloud, Matcher& matcher, const EvidenceMap& evidence,
                    const Rays& rays) {
  Localisation found = from_match(cloud, matcher.match(cloud, std::nullopt));
  weigh(evidence, rays, found.modes);
  if (wants_rivals(found)) {
    const double unseen = found.unseen;
    found = from_match(cloud, matcher.match_rivals(cloud));
    found.unseen = std::min(found.unseen, unseen);
    weigh(evidence, rays, found.modes);
  }
  found.searched_whole_map = true;
  return found;
}

LocalisationState state_of(const std::vector<PoseMode>& modes) {
  if (modes.empty()) return LocalisationState::kLost;
  if (modes.front().probability >= kSure) return LocalisationState::kTracking;
  double any = 0.0;
  for (const PoseMode& mode : modes) any += mode.probability;
  return any >= kLikely ? LocalisationState::kAmbiguous : LocalisationState::kLost;
}

}  // namespace

Localisation from_match(const Cloud& cloud, const Match& match) {
  Localisation result;
  result.utime_us = cloud.utime_us;
  for (const MatchMode& mode : match.modes) result.modes.push_back(pose_mode(mode));
  result.certified = match.certified;
  result.unseen = match.unseen;
  result.poses_examined = match.poses_examined;
  result.significance_log10 = match.significance_log10;
  return result;
}

Localisation LostSearch::add(const Cloud& cloud, const std::optional<Pose2>& T_odom_base,
                             Matcher& matcher, const EvidenceMap& evidence) {
  const Rays rays(cloud);
  Localisation result = search(cloud, matcher, evidence, rays);
  // Nearly blind: the places wait for a better scan.
  if (rays.near.size() < kFewestMatchPoints) return result;
  if (!hypotheses_.empty()) {
    if (const auto motion = motion_to(cloud, T_odom_base))
      hypotheses_.move(*motion);
    else
      hypotheses_.clear();
  }
  std::vector<PoseMode> again;
  for (const PoseMode& expected : hypotheses_.places())
    if (!lists(result.modes, expected.T_map_base))
      again.push_back(found_again(matcher, cloud, expected));
  weigh(evidence, rays, again);
  result.modes.insert(result.modes.end(), again.begin(), again.end());
  hypotheses_.weigh(result.modes, result.unseen);
  last_ = cloud;
  T_odom_last_ = T_odom_base;
  result.modes = hypotheses_.modes();
  result.state = state_of(result.modes);
  if (!result.modes.empty()) result.confidence = result.modes.front().probability;
  return result;
}

std::optional<Pose2> LostSearch::motion_to(const Cloud& cloud,
                                           const std::optional<Pose2>& T_odom_base) const {
  if (T_odom_last_ && T_odom_base) return T_odom_last_->inverse() * *T_odom_base;
  const double dt_s = static_cast<double>(cloud.utime_us - last_.utime_us) * 1e-6;
  if (dt_s <= 0.0 || dt_s > 3.0) return std::nullopt;
  const double reach_m = kOff_m + limits_.speed_mps * dt_s;
  return scan_motion(last_, cloud,
                     {{}, reach_m, reach_m, kOff_rad + limits_.turn_rate_radps * dt_s}, config_);
}

}  // namespace voxlist::matching
