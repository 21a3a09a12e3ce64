#include "voxlist/matching/localisation/localiser.h"

#include <algorithm>
#include <numbers>

#include "voxlist/matching/engines/match_modes.h"
#include "voxlist/matching/localisation/lost_search.h"
#include "voxlist/matching/localisation/pose_track.h"
#include "voxlist/matching/surfaces/evidence.h"

namespace voxlist::matching {
namespace {

// Of a pose that goes on explaining what the robot sees, after a past that was sure.
constexpr double kTracked = 0.99;

// Poses are weighed by what is plainly there or not: maps are sparse in places, and so alike rooms
// would differ by chance.
constexpr double kReach_m = 0.08;

// Rays that weigh a tracked pose.
constexpr std::size_t kRays = 600;

// A pose that far away, and so much better supported, makes a doubtful one lost.
constexpr double kElsewhere_m = 0.2, kBetter = 0.03;

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
    : map_(map), config_(config), revision_(map.revision()) {
  if (map_.empty())
    make_matcher(map_,
                 config_.matcher);  // complains about a wrong engine now, not at the first cloud
}

Localiser::~Localiser() = default;

void Localiser::map_grew(const ChangedBlocks& grown) {
  if (grown.from != revision_) return;  // follow_map() will see to all changes
  revision_ = grown.to;
  if (matcher_) matcher_->map_grew(grown);
  if (evidence_) evidence_->map_grew(grown);
}

void Localiser::follow_map() {
  if (map_.revision() == revision_) return;
  revision_ = map_.revision();
  matcher_.reset();
  evidence_.reset();
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
  if (!evidence_) evidence_ = std::make_unique<EvidenceMap>(map_, kReach_m);
  return *evidence_;
}

Localisation Localiser::localise(const Cloud& cloud, const std::optional<Pose2>& T_odom_base) {
  follow_map();
  if (!map_.empty() && track_) {
    if (const auto tracked = track(cloud, T_odom_base)) return *tracked;
    track_.reset();
  }
  Localisation result;
  std::optional<double> support;
  if (map_.empty()) {
    result = origin(cloud);
  } else {
    if (!search_) search_ = std::make_unique<LostSearch>(config_.matcher, limits());
    result = search_->add(cloud, T_odom_base, matcher(), evidence());
    if (result.tracking()) support = result.modes.front().even_support;
  }
  if (result.tracking()) {
    track_ =
        std::make_unique<PoseTrack>(cloud, T_odom_base, result.modes.front().T_map_base, support);
    search_.reset();
  }
  return result;
}

Localisation Localiser::locate(const Cloud& cloud) {
  follow_map();
  return LostSearch(config_.matcher, limits()).add(cloud, std::nullopt, matcher(), evidence());
}

Localisation Localiser::origin(const Cloud& cloud) {
  Localisation result;
  result.utime_us = cloud.utime_us;
  if (cloud.points.size() < kFewestMatchPoints) return result;
  result.state = LocalisationState::kTracking;
  result.modes.push_back({Pose2{}, Eigen::Matrix3d::Zero(), 0.0, 0.0, 0.0, 1.0});
  result.confidence = 1.0;
  result.certified = true;
  return result;
}

std::optional<Localisation> Localiser::track(const Cloud& cloud,
                                             const std::optional<Pose2>& T_odom_base) {
  const Match match = track_->match(matcher(), cloud, T_odom_base, limits());
  if (match.modes.empty()) return std::nullopt;
  const MatchMode& mode = match.modes.front();
  const auto rays = choose_evidence_rays(cloud, kRays);
  const Evidence seen = evidence().at(mode.pose, rays);
  const PoseTrack::Judgement judgement = track_->judge(cloud, T_odom_base, mode, seen);
  if (judgement.verdict == PoseTrack::Verdict::kLost) return std::nullopt;
  if (judgement.verdict == PoseTrack::Verdict::kDoubtful &&
      fits_better_elsewhere(cloud, rays, mode.pose, judgement.worth))
    return std::nullopt;
  track_->advance(cloud, T_odom_base, mode, seen);
  Localisation result = from_match(cloud, match);
  result.state = LocalisationState::kTracking;
  result.confidence = result.modes.front().probability = kTracked;
  return result;
}

bool Localiser::fits_better_elsewhere(const Cloud& cloud, const std::vector<EvidenceRay>& rays,
                                      const Pose2& pose, double worth) {
  const Match match = matcher().match(cloud, std::nullopt);
  return std::any_of(match.modes.begin(), match.modes.end(), [&](const MatchMode& mode) {
    return distance_m(mode.pose, pose) > kElsewhere_m &&
           support(evidence().at(mode.pose, rays)) > worth + kBetter;
  });
}

}  // namespace voxlist::matching
