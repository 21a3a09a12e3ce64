#include "voxlist/matching/localisation/lost_search.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "voxlist/matching/engines/global_matcher.h"
#include "voxlist/matching/localisation/reach_match.h"
#include "voxlist/matching/localisation/scan_motion.h"

namespace voxlist::matching {
namespace {

// A mode is sure from this probability on: TRACKING. Set after building seeds 131 to 137, where a
// foreign drive had come to 0.992 and more; on seeds 141 to 147 none of 2240 scans and 546 drives
// was wrong. Lower: wrong TRACKING in foreign buildings; higher: more scans until a robot knows
// where it is.
constexpr double kSure = 0.996;
// One of the modes is probably right when they have this probability together: AMBIGUOUS rather
// than LOST. Chosen by judgement: it is what a planner is told, no map depends on it.
constexpr double kLikely = 0.2;
// Rivals are looked for, unless the best mode is as sure as this without them. At 0.9995, two
// foreign scans of 1920 (seeds 131 to 137) passed for places of the map. Higher: more second
// searches, about 20 ms each.
constexpr double kPlain = 0.99999;

// How far off a hypothesis may be after a motion (m, rad): what odometry or two matched scans are
// off by over one step, with room. Chosen by judgement; a hypothesis that is off by more is found
// by the search of the whole map, or given up.
constexpr double kOff_m = 0.3, kOff_rad = 0.12;
// A hint is looked at no farther than this (m) to each side.
constexpr double kWidestHint_m = 5.0;
// A robot that moved less than this (m) between two scans stands, or turns on the spot, and sees
// the same again. Chosen by judgement: well below what a driving robot moves in the second of a
// sweep.
constexpr double kStanding_m = 0.05;
// A robot that stands sees at least this share of a scan's points where they were, unless it was
// carried: of a corridor and a room about 0.3 are. Chosen by judgement. Lower: some places pass for
// each other; higher: a person who steps in front does for a carry, and the scan is judged alone.
constexpr double kLeastSame = 0.6;
// Without odometry, scans farther apart in time (s) than this are not matched with each other.
constexpr double kLongestGap_s = 3.0;

PoseMode pose_mode(const MatchMode& mode) {
  return {mode.pose, {}, mode.covariance, mode.overlap_ratio, {}, 0.0};
}

bool lists(const std::vector<PoseMode>& modes, const Pose2& pose) {
  return std::any_of(modes.begin(), modes.end(), [&](const PoseMode& mode) {
    return distance_m(mode.T_map_base, pose) < kOff_m && turn_rad(mode.T_map_base, pose) < kOff_rad;
  });
}

// Above people's heads there is little that another building lacks: where only a band of heights is
// matched, a place must be likelier by this logarithm of odds. Chosen on seed 1 of
// bench_ceiling; with 0 two of 40 scans of another building were claimed.
constexpr double kDoubtOfBand = 3.0;

// A hypothesis that has moved, where the scan fits best; where it was expected if it fits nowhere.
PoseMode found_again(Matcher& matcher, const PreparedScan& scan, const PoseMode& expected) {
  const Match match =
      matcher.match(scan, PoseWindow{expected.T_map_base, kOff_m, kOff_m, kOff_rad});
  return match.modes.empty() ? expected : pose_mode(match.modes.front());
}

PoseSupport support_at(const EvidenceMap& evidence, const PreparedScan& scan, const Pose2& pose) {
  return {support_of(evidence.at(pose, scan.near_rays())),
          support_of(evidence.at(pose, scan.even_rays()))};
}

// Weighs modes; those that were weighed before keep what they had.
void weigh(Matcher& matcher, const PreparedScan& scan, const std::vector<PoseMode>& before,
           std::vector<PoseMode>& modes) {
  for (PoseMode& mode : modes) {
    const auto known = std::find_if(before.begin(), before.end(), [&](const PoseMode& other) {
      return other.T_map_base == mode.T_map_base;
    });
    mode.support = known == before.end() ? support_at(matcher.evidence(), scan, mode.T_map_base)
                                         : known->support;
  }
}

// Whether the best mode is neither plainly right, nor has a listed rival that comes nearer than one
// that is not listed may come. A search that was ended early would not do better with more to look
// for.
bool wants_rivals(const Localisation& found) {
  if (found.modes.empty() || found.unseen >= 1.0) return false;
  const PoseMode& best = *std::max_element(
      found.modes.begin(), found.modes.end(),
      [](const auto& a, const auto& b) { return a.support.near < b.support.near; });
  const double unseen = found.unseen * best.support.even;
  const LogOdds odds = log_odds_of(best.support, unseen, {});
  return rival_support(best, found.modes, 0.0) < unseen &&
         probabilities({&odds, 1}).front() < kPlain;
}

Localisation search(const PreparedScan& scan, Matcher& matcher) {
  Localisation found = from_match(scan, matcher.match(scan, std::nullopt));
  weigh(matcher, scan, {}, found.modes);
  if (wants_rivals(found)) {
    const Localisation first = std::move(found);
    found = from_match(scan, matcher.match_rivals(scan));
    found.unseen = std::min(found.unseen, first.unseen);
    weigh(matcher, scan, first.modes, found.modes);
  }
  found.searched_whole_map = true;
  return found;
}

// Whether one scan makes a place probable, beside such rivals as no search would list.
bool is_likely(const PoseMode& mode) {
  const LogOdds odds = log_odds_of(mode.support, kModeRatio * mode.support.even, {});
  return probabilities({&odds, 1}).front() >= kLikely;
}

// Adds likely places near a hint that the search did not list, as one may that was ended early.
void add_places_near(const UncertainPose& hint, const PreparedScan& scan, Matcher& matcher,
                     std::vector<PoseMode>& modes) {
  PoseWindow window = window_about(hint);
  window.half_x_m = std::min(window.half_x_m, kWidestHint_m);
  window.half_y_m = std::min(window.half_y_m, kWidestHint_m);
  std::vector<PoseMode> places;
  for (const MatchMode& mode : matcher.match(scan, window).modes)
    if (!lists(modes, mode.pose)) places.push_back(pose_mode(mode));
  weigh(matcher, scan, {}, places);
  std::copy_if(places.begin(), places.end(), std::back_inserter(modes), is_likely);
}

LocalisationState state_of(const std::vector<PoseMode>& modes) {
  if (modes.empty()) return LocalisationState::kLost;
  if (modes.front().probability >= kSure) return LocalisationState::kTracking;
  double any = 0.0;
  for (const PoseMode& mode : modes) any += mode.probability;
  return any >= kLikely ? LocalisationState::kAmbiguous : LocalisationState::kLost;
}

// What the place that was found may be off by (m, rad), as standard deviations, for all that the
// search knows; and how far the surfaces are asked about it.
constexpr double kOffPlace_m = 1.0, kOffPlace_rad = 0.1;
constexpr double kRoundPlace_m = 0.3, kRoundPlace_rad = 0.05;

// What the surfaces in sight hold the best place by. Along a bare corridor that is nothing, however
// probable the corridor: then the place is not told as one pose.
void tell_what_holds(Matcher& matcher, const PreparedScan& scan, Localisation& result) {
  PoseMode& best = result.modes.front();
  const UncertainPose vague{best.T_map_base,
                            Eigen::Vector3d(kOffPlace_m * kOffPlace_m, kOffPlace_m * kOffPlace_m,
                                            kOffPlace_rad * kOffPlace_rad)
                                .asDiagonal()};
  const PoseWindow window{best.T_map_base, kRoundPlace_m, kRoundPlace_m, kRoundPlace_rad};
  PoseMode held = best;
  held.covariance = vague.covariance;
  for (const MatchMode& mode : matcher.track(scan, window, vague).modes)
    if (distance_m(mode.pose, best.T_map_base) < kRoundPlace_m &&
        mode.covariance.trace() < held.covariance.trace())
      held.covariance = mode.covariance;
  if (is_exact(held.covariance)) return;
  best.covariance = held.covariance;
  result.state = LocalisationState::kAmbiguous;
}

}  // namespace

Localisation from_match(const PreparedScan& scan, const Match& match) {
  Localisation result;
  result.utime_us = scan.cloud().utime_us;
  for (const MatchMode& mode : match.modes) result.modes.push_back(pose_mode(mode));
  result.certified = match.certified;
  result.unseen = match.unseen;
  result.poses_examined = match.poses_examined;
  result.significance_log10 = match.significance_log10;
  return result;
}

LostSearch::LostSearch(const MatcherConfig& config, const MotionLimits& limits)
    : config_(config),
      limits_(limits),
      hypotheses_(config.scan.match_heights_m.empty() ? 0.0 : kDoubtOfBand) {}

Localisation LostSearch::add(const PreparedScan& scan, const std::optional<Pose2>& T_odom_base,
                             Matcher& matcher, const std::optional<UncertainPose>& hint) {
  Localisation result = search(scan, matcher);
  // Nearly blind: the hypotheses wait for a better scan.
  if (scan.near_rays().size() < kFewestMatchPoints) return result;
  if (hint) add_places_near(*hint, scan, matcher, result.modes);
  follow(scan, T_odom_base);
  find_again(scan, matcher, result.modes);
  hypotheses_.update(result.modes, result.unseen);
  last_ = scan.cloud();
  T_odom_last_ = T_odom_base;
  result.modes = hypotheses_.modes();
  result.state = state_of(result.modes);
  if (!result.modes.empty()) result.confidence = result.modes.front().probability;
  if (result.tracking()) tell_what_holds(matcher, scan, result);
  return result;
}

// Moves the hypotheses as the robot moved; without a motion they are worth nothing.
void LostSearch::follow(const PreparedScan& scan, const std::optional<Pose2>& T_odom_base) {
  const bool is_carried = was_carried(scan, T_odom_base);
  // The sweep in which it was carried shows both places.
  const bool is_other_place = std::exchange(is_carried_, is_carried) || is_carried;
  if (is_other_place || !stands(T_odom_base)) standing_ = {scan.cloud(), T_odom_base};
  if (hypotheses_.empty()) return;
  const auto motion = motion_to(scan, T_odom_base);
  if (motion && !is_other_place)
    hypotheses_.move(*motion);
  else
    hypotheses_.clear();
}

bool LostSearch::stands(const std::optional<Pose2>& T_odom_base) const {
  return standing_.T_odom_base && T_odom_base &&
         distance_m(*standing_.T_odom_base, *T_odom_base) < kStanding_m;
}

// Whether a robot whose wheels stand sees something else than when they came to stand. Such a scan
// would count for nothing beside what was believed of the place before (Hypotheses::move).
bool LostSearch::was_carried(const PreparedScan& scan,
                             const std::optional<Pose2>& T_odom_base) const {
  if (!stands(T_odom_base)) return false;
  const Pose2 motion = standing_.T_odom_base->inverse() * *T_odom_base;
  return !scan_motion(standing_.cloud, scan, {motion, kOff_m, kOff_m, kOff_rad}, config_,
                      kLeastSame);
}

std::optional<Pose2> LostSearch::motion_to(const PreparedScan& scan,
                                           const std::optional<Pose2>& T_odom_base) const {
  if (T_odom_last_ && T_odom_base) return T_odom_last_->inverse() * *T_odom_base;
  const double dt_s = static_cast<double>(scan.cloud().utime_us - last_.utime_us) * 1e-6;
  if (dt_s <= 0.0 || dt_s > kLongestGap_s) return std::nullopt;
  const double reach_m = kOff_m + limits_.speed_mps * dt_s;
  return scan_motion(last_, scan, {{}, reach_m, reach_m, kOff_rad + limits_.turn_rate_radps * dt_s},
                     config_);
}

// Adds the hypotheses that the search did not list.
void LostSearch::find_again(const PreparedScan& scan, Matcher& matcher,
                            std::vector<PoseMode>& modes) const {
  std::vector<PoseMode> again;
  for (const PoseMode& expected : hypotheses_.poses())
    if (!lists(modes, expected.T_map_base)) again.push_back(found_again(matcher, scan, expected));
  weigh(matcher, scan, {}, again);
  modes.insert(modes.end(), again.begin(), again.end());
}

}  // namespace voxlist::matching
