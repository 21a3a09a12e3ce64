#include "matching/localiser.h"

#include <numbers>

#include "matching/evidence.h"
#include "matching/lost_search.h"
#include "matching/pose_track.h"

namespace voxlist {
namespace {

// Of a pose that goes on explaining what the robot sees, after a past that was sure.
constexpr double kTracked = 0.99;

// Rays that weigh a tracked pose.
constexpr std::size_t kRays = 600;

}  // namespace

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
    : map_(map), config_(config) {
  if (map_.empty())
    make_matcher(map_,
                 config_.matcher);  // complains about a wrong engine now, not at the first cloud
}

Localiser::~Localiser() = default;

void Localiser::map_changed() {
  matcher_.reset();
  evidence_.reset();
}

void Localiser::map_grew(const ChangedBlocks& grown) {
  if (matcher_) matcher_->map_grew(grown);
  if (evidence_) evidence_->map_grew(grown);
}

void Localiser::forget() {
  track_.reset();
  search_.reset();
}

MotionLimits Localiser::limits() const {
  return {config_.max_speed_mps, config_.max_turn_rate_dps * std::numbers::pi / 180.0};
}

Matcher& Localiser::matcher() {
  if (!matcher_) matcher_ = make_matcher(map_, config_.matcher);
  return *matcher_;
}

const EvidenceMap& Localiser::evidence() {
  if (!evidence_) evidence_ = std::make_unique<EvidenceMap>(map_);
  return *evidence_;
}

Localisation Localiser::localise(const Cloud& cloud, const std::optional<Pose2>& T_odom_base) {
  if (!map_.empty() && track_) {
    if (const auto tracked = track(cloud, T_odom_base)) return *tracked;
    track_.reset();
  }
  Localisation result;
  if (map_.empty()) {
    result = origin(cloud);
  } else {
    if (!search_) search_ = std::make_unique<LostSearch>(config_.matcher, limits());
    result = search_->add(cloud, T_odom_base, matcher(), evidence());
  }
  if (result.tracking()) {
    track_ = std::make_unique<PoseTrack>(cloud, T_odom_base, result.modes.front().T_map_base);
    search_.reset();
  }
  return result;
}

Localisation Localiser::locate(const Cloud& cloud) {
  return LostSearch(config_.matcher, limits()).add(cloud, std::nullopt, matcher(), evidence());
}

Localisation Localiser::origin(const Cloud& cloud) {
  Localisation result;
  result.utime_us = cloud.utime_us;
  if (cloud.points.size() < kFewestMatchPoints) return result;
  result.state = LocalisationState::kTracking;
  result.modes.push_back({Pose2{}, Eigen::Matrix3d::Zero(), 0.0, 0.0, 1.0});
  result.confidence = 1.0;
  result.certified = true;
  return result;
}

std::optional<Localisation> Localiser::track(const Cloud& cloud,
                                             const std::optional<Pose2>& T_odom_base) {
  const Match match = track_->match(matcher(), cloud, T_odom_base, limits());
  if (match.modes.empty()) return std::nullopt;
  const MatchMode& mode = match.modes.front();
  const Evidence seen = evidence().at(mode.pose, choose_evidence_rays(cloud, kRays));
  if (!track_->explains(mode, seen)) return std::nullopt;
  track_->advance(cloud, T_odom_base, mode, seen);
  Localisation result = from_match(cloud, match);
  result.state = LocalisationState::kTracking;
  result.confidence = result.modes.front().probability = kTracked;
  return result;
}

}  // namespace voxlist
