#include "voxlist/matching/localisation/localiser.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxlist/geometry/angle.h"
#include "voxlist/matching/localisation/lost_search.h"
#include "voxlist/matching/localisation/pose_track.h"
#include "voxlist/matching/localisation/reach_match.h"

namespace voxlist::matching {
namespace {

// One of the places in reach is probably right when they have this probability together: as where
// the whole map is searched.
constexpr double kLikely = 0.2;
// A pose is told as one only where it is known to so much (m), as a standard deviation in the worst
// direction: about a robot's size.
constexpr double kExact_m = 0.3;
// A scan is level when its floor leans by less (rad). Of 560 scans of a street, a hall and
// stop-and-scan stations none leans by more than 4.1 deg.
constexpr double kLevel_rad = 5.0 * kRadPerDeg;

LocalisationState state_of(const Localisation& tracked) {
  double any = 0.0;
  for (const PoseMode& mode : tracked.modes) any += mode.probability;
  if (any < kLikely) return LocalisationState::kLost;
  const bool told =
      tracked.confidence >= kSureInReach && is_exact(tracked.modes.front().covariance);
  return told ? LocalisationState::kTracking : LocalisationState::kAmbiguous;
}

// A pose of which nothing is known: the whole map is as near as any place.
UncertainPose anywhere() {
  constexpr double kAnywhere = 1e6;  // m and rad
  return {{}, kAnywhere * kAnywhere * Eigen::Matrix3d::Identity()};
}

// A search that did not look at everything says nothing of rivals.
LocalisationState state_of_recognised(const Localisation& found) {
  const LocalisationState state = state_of(found);
  const bool sure = state == LocalisationState::kTracking && found.unseen < 1.0;
  return sure || state == LocalisationState::kLost ? state : LocalisationState::kAmbiguous;
}

Localisation from_reach(const PreparedScan& scan, const ReachMatch& reach) {
  Localisation result = from_match(scan, reach.match);
  for (std::size_t i = 0; i < result.modes.size(); ++i)
    result.modes[i].probability = reach.probabilities[i];
  result.confidence = reach.best();
  return result;
}

// The cloud that begins a map is at the map's origin.
Localisation origin_of_map(const PreparedScan& scan) {
  Localisation result;
  result.utime_us = scan.cloud().utime_us;
  if (scan.in_range().size() < kFewestMatchPoints) return result;
  result.state = LocalisationState::kTracking;
  result.modes.push_back({Pose2{}, {}, Eigen::Matrix3d::Zero(), 0.0, {}, 1.0});
  result.confidence = 1.0;
  result.certified = true;
  return result;
}

}  // namespace

bool is_exact(const Eigen::Matrix3d& covariance) { return worst_sigma_m(covariance) < kExact_m; }

const char* name(LocalisationState state) {
  switch (state) {
    case LocalisationState::kAmbiguous:
      return "AMBIGUOUS";
    case LocalisationState::kTracking:
      return "TRACKING";
    case LocalisationState::kLost:
      break;
  }
  return "LOST";
}

Localiser::Localiser(const OccupancyMap& map, const LocaliserConfig& config)
    : map_(map), config_(config), revision_(map.revision()), threads_(config.threads) {
  check(config.matcher.scan);
}

Localiser::~Localiser() = default;

void Localiser::map_changed(const ChangedBlocks& changed) {
  if (changed.from != revision_) return;  // follow_map() will see to all changes
  revision_ = changed.to;
  if (matcher_) matcher_->map_changed(changed);
}

void Localiser::follow_map() {
  if (map_.revision() == revision_) return;
  revision_ = map_.revision();
  matcher_.reset();
  standing_heights_.clear();
}

bool Localiser::hint(const UncertainPose& pose) {
  if (map_.empty() || (track_ && !track_->doubtful())) return false;
  hint_.take(pose);
  return true;
}

void Localiser::forget() {
  hint_.forget();
  track_.reset();
  search_.reset();
  levelling_.forget();
  floor_belief_.clear();
}

MotionLimits Localiser::limits() const {
  return {config_.max_speed_mps, config_.max_turn_rate_dps * std::numbers::pi / 180.0};
}

Matcher& Localiser::matcher() {
  if (!matcher_) matcher_ = make_matcher(map_, config_.matcher);
  return *matcher_;
}

Localisation Localiser::localise(const Cloud& cloud, const std::optional<Pose2>& T_odom_base,
                                 const std::optional<Tilt>& odometry_tilt) {
  const std::optional<Pose2> T_level_base = seen_from_above(T_odom_base, odometry_tilt);
  std::optional<Pose2> expected;
  if (track_) expected = track_->predict(cloud.utime_us, T_level_base).pose;
  hinted_ = hint_.next(T_level_base);
  Localisation result = answered(cloud, expected, odometry_tilt, [&](const PreparedScan& scan) {
    return localise(scan, T_level_base);
  });
  if (result.tracking()) {
    hint_.forget();
    const PoseMode& best = result.modes.front();
    levelling_.learn(best.T_map_base, best.tilt, result.floor);
  }
  if (T_odom_base) level_odometry_.note(*T_odom_base, odometry_tilt.value_or(levelling_.last()));
  return result;
}

// Planar odometry is as it is.
std::optional<Pose2> Localiser::seen_from_above(const std::optional<Pose2>& T_odom_base,
                                                const std::optional<Tilt>& odometry_tilt) const {
  if (!T_odom_base || config_.tilt == TiltUse::kPlanar) return T_odom_base;
  return level_odometry_.seen_from_above(*T_odom_base, odometry_tilt.value_or(levelling_.last()));
}

Localisation Localiser::answered(const Cloud& cloud, const std::optional<Pose2>& expected,
                                 const std::optional<Tilt>& odometry_tilt, const Locate& locate) {
  follow_map();
  KnownTilt known{find_floor(cloud), std::nullopt};
  if (config_.tilt == TiltUse::kOdometry) known.odometry = odometry_tilt;
  Localisation result;
  threads_.run([&] {
    result = config_.tilt == TiltUse::kPlanar ? locate_level(cloud, known, locate)
                                              : locate_tilted(cloud, known, expected, locate);
  });
  result.floor = known.floor;
  return result;
}

// A scan that is not level is LOST whatever it fits.
Localisation Localiser::locate_level(const Cloud& cloud, const KnownTilt& known,
                                     const Locate& locate) {
  if (!known.floor || known.floor->lean_rad() < kLevel_rad)
    return locate(PreparedScan(cloud, config_.matcher.scan));
  Localisation lost;
  lost.utime_us = cloud.utime_us;
  return lost;
}

std::optional<UncertainPose> Localiser::predict(std::int64_t utime_us,
                                                const std::optional<Pose2>& T_odom_base) const {
  return track_
             ? std::optional(track_->predict(utime_us, seen_from_above(T_odom_base, std::nullopt)))
             : std::nullopt;
}

Localisation Localiser::locate(const Cloud& cloud) {
  return answered(cloud, std::nullopt, std::nullopt, [&](const PreparedScan& scan) {
    return LostSearch(config_.matcher, limits()).add(scan, std::nullopt, matcher());
  });
}

Localisation Localiser::recognise(const Cloud& cloud, double here) {
  return answered(cloud, std::nullopt, std::nullopt, [&](const PreparedScan& scan) {
    Localisation result =
        from_reach(scan, match_in_reach(matcher(), scan, anywhere(), here, Rivals::kAnywhere));
    result.searched_whole_map = true;
    result.state = state_of_recognised(result);
    return result;
  });
}

Localisation Localiser::recognise_near(const Cloud& cloud, const UncertainPose& expected) {
  return answered(cloud, expected.pose, std::nullopt, [&](const PreparedScan& scan) {
    Localisation result = from_reach(scan, match_in_reach(matcher(), scan, expected, kSureInReach));
    result.state = state_of(result);
    return result;
  });
}

void Localiser::take_over(Localiser& other, const Pose2& T_this_other) {
  hint_.forget();
  track_ = std::move(other.track_);
  search_.reset();
  odometry_check_.clear();
  levelling_ = other.levelling_;
  levelling_.change_map(T_this_other);
  standing_heights_.clear();
  floor_belief_.clear();
  level_odometry_ = other.level_odometry_;
  if (track_) track_->change_map(T_this_other);
}

void Localiser::move(const Pose2& T_new_old) {
  hint_.forget();
  search_.reset();
  odometry_check_.clear();
  levelling_.change_map(T_new_old);
  if (track_) track_->change_map(T_new_old);
}

Localisation Localiser::localise(const PreparedScan& scan,
                                 const std::optional<Pose2>& T_odom_base) {
  if (map_.empty()) return begin(scan, T_odom_base);
  if (track_) {
    const Localisation tracked = track(scan, T_odom_base);
    if (tracked.tracking()) search_.reset();
    if (tracked.confidence >= kSureInReach || !track_->doubtful()) return tracked;
  }
  const Localisation result = search(scan, T_odom_base);
  if (!result.tracking()) return result;
  const PoseMode& mode = result.modes.front();
  start_at(result.utime_us, T_odom_base, {mode.T_map_base, mode.covariance});
  return result;
}

void Localiser::start_at(std::int64_t utime_us, const std::optional<Pose2>& T_odom_base,
                         const UncertainPose& pose) {
  track_ = std::make_unique<PoseTrack>(utime_us, T_odom_base, pose, limits());
  search_.reset();
  odometry_check_.clear();
  odometry_check_.add(utime_us, pose, T_odom_base);
}

Localisation Localiser::begin(const PreparedScan& scan, const std::optional<Pose2>& T_odom_base) {
  const Localisation result = origin_of_map(scan);
  if (result.tracking()) start_at(result.utime_us, T_odom_base, {});
  return result;
}

Localisation Localiser::search(const PreparedScan& scan, const std::optional<Pose2>& T_odom_base) {
  if (!search_) search_ = std::make_unique<LostSearch>(config_.matcher, limits());
  return search_->add(scan, T_odom_base, matcher(), hinted_);
}

Localisation Localiser::track(const PreparedScan& scan, const std::optional<Pose2>& T_odom_base) {
  Localisation result = track_->match(matcher(), scan, T_odom_base);
  // A scan that is nearly blind says neither that the robot is there, nor that it is not.
  if (scan.points().points.size() >= kFewestMatchPoints) track_->doubt(result.confidence);
  result.state = state_of(result);
  if (result.confidence < kSureInReach) return result;
  PoseMode& mode = result.modes.front();
  const UncertainPose matched{mode.T_map_base, mode.covariance};
  result.odometry_error = odometry_check_.add(scan.cloud().utime_us, matched, T_odom_base);
  const UncertainPose pose = track_->advance(scan.cloud().utime_us, T_odom_base, matched);
  mode.T_map_base = pose.pose;
  mode.covariance = pose.covariance;
  if (T_odom_base) result.odometry_bias = track_->odometry();
  return result;
}

}  // namespace voxlist::matching
