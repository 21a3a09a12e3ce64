#include "matching/lost_search.h"

#include <algorithm>

#include "matching/match_modes.h"
#include "matching/scan_motion.h"

namespace voxlist {
namespace {

// What counts as sure, and when one of the modes is probably right.
constexpr double kSure = 0.992, kLikely = 0.2;

// Many rays close together: places may be alike but for a small thing.
constexpr std::size_t kRays = 3000;
constexpr double kSpacing_m = 0.05;

// How far a place may be off after a motion.
constexpr double kOff_m = 0.3, kOff_rad = 0.12;

PoseMode pose_mode(const MatchMode& mode) {
  return {mode.pose, mode.covariance, mode.overlap, 0.0, 0.0};
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
  result.poses_examined = match.poses_examined;
  result.significance_log10 = match.significance_log10;
  return result;
}

Localisation LostSearch::add(const Cloud& cloud, const std::optional<Pose2>& T_odom_base,
                             Matcher& matcher, const EvidenceMap& evidence) {
  Localisation result = from_match(cloud, matcher.match(cloud, std::nullopt));
  result.global = true;
  const auto rays = choose_evidence_rays(cloud, kRays, kSpacing_m);
  // Nearly blind: the places wait for a better scan.
  if (rays.size() < kFewestMatchPoints) return result;
  if (!hypotheses_.empty()) {
    if (const auto motion = motion_to(cloud, T_odom_base))
      hypotheses_.move(*motion);
    else
      hypotheses_.clear();
  }
  std::vector<PoseMode> modes = result.modes;
  for (const PoseMode& expected : hypotheses_.places())
    if (!lists(result.modes, expected.T_map_base))
      modes.push_back(found_again(matcher, cloud, expected));
  for (PoseMode& mode : modes) mode.support = support(evidence.at(mode.T_map_base, rays));
  hypotheses_.weigh(modes);
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

}  // namespace voxlist
