#include "matching/localiser.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxlist {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

// Global: what is needed to call a pose sure, beside having no rival.
constexpr double kSureOverlap = 0.75;
// Global: below this nothing fits.
constexpr double kLostOverlap = 0.4;
// Tracking: the pose is lost below this overlap, or below this share of the last fit.
constexpr double kTrackOverlap = 0.15;
constexpr double kTrackFitShare = 0.4;
// The window grows to all that motion allows when the fit falls below this share of the last one.
constexpr double kDoubtfulFitShare = 0.8;

// How far a prediction may be off, beside a share of the motion itself.
constexpr double kWindow_m = 0.4, kWindow_rad = 0.3;
constexpr double kWindowShare = 0.2;

// A heavy-tailed prior on the distance from the prediction: decides between poses that fit alike.
// Odometry is worth more than a guess from the last step.
struct Prior {
  double weight, scale_m, scale_rad;
};
constexpr Prior kGuess{0.08, 0.5, 0.5}, kOdometry{0.2, 0.1, 0.1};

double prior_cost(const Pose2& pose, const Pose2& predicted, const Prior& prior) {
  const double d = distance_m(pose, predicted) / prior.scale_m,
               turn = turn_rad(pose, predicted) / prior.scale_rad;
  return prior.weight * std::log1p(d * d + turn * turn);
}

Localisation from_match(const Cloud& cloud, const Match& match) {
  Localisation result;
  result.utime_us = cloud.utime_us;
  for (const MatchMode& mode : match.modes)
    result.modes.push_back({mode.pose, mode.covariance, mode.overlap});
  result.certified = match.certified;
  result.poses_examined = match.poses_examined;
  result.significance_log10 = match.significance_log10;
  return result;
}

// Moves mode `best` to the front.
void put_first(Localisation& result, std::size_t best) {
  std::rotate(result.modes.begin(), result.modes.begin() + static_cast<std::ptrdiff_t>(best),
              result.modes.begin() + static_cast<std::ptrdiff_t>(best) + 1);
}

// Rises from 0 to 1 as the second mode falls behind; 0.9 where the first counts as sure.
double confidence_of(double rivalry) {
  const double margin = (1.0 - rivalry) / 0.06;
  return 1.0 / (1.0 + std::exp(-(margin + std::log(9.0))));
}

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

// What tracking goes on from.
struct Localiser::Track {
  std::int64_t utime_us = 0;
  Pose2 pose;
  std::optional<Pose2> T_odom_base;
  // Motion of the last step in base, and how long it took: the prediction without odometry.
  Pose2 step;
  double step_s = 0.0;
  // Of the last cloud; 0: it began the map, so there is nothing to compare with.
  double fit = 0.0;

  Pose2 predict(std::int64_t now_us, const std::optional<Pose2>& T_odom_now) const {
    if (T_odom_base && T_odom_now) return pose * (T_odom_base->inverse() * *T_odom_now);
    const double dt_s = static_cast<double>(now_us - utime_us) * 1e-6;
    // Only over steps alike: after a gap the old speed says nothing.
    return step_s > 0.0 && dt_s > 0.0 && dt_s < 2.0 * step_s ? pose * step : pose;
  }
};

Localiser::Localiser(const OccupancyMap& map, const LocaliserConfig& config)
    : map_(map), config_(config) {
  if (map_.empty())
    make_matcher(map_,
                 config_.matcher);  // complains about a wrong engine now, not at the first cloud
}

Localiser::~Localiser() = default;

void Localiser::map_changed() { matcher_.reset(); }

void Localiser::forget() { track_.reset(); }

Matcher& Localiser::matcher() {
  if (!matcher_) matcher_ = make_matcher(map_, config_.matcher);
  return *matcher_;
}

Localisation Localiser::localise(const Cloud& cloud, const std::optional<Pose2>& T_odom_base) {
  Localisation result;
  double fit = 0.0;
  if (map_.empty()) {
    result = origin(cloud);
  } else {
    if (track_) result = track(cloud, T_odom_base, fit);
    if (!result.tracking()) result = locate(cloud, fit);
  }
  if (result.tracking()) remember(cloud, T_odom_base, result.modes.front().T_map_base, fit);
  return result;
}

Localisation Localiser::locate(const Cloud& cloud) {
  double fit = 0.0;
  return locate(cloud, fit);
}

Localisation Localiser::origin(const Cloud& cloud) {
  Localisation result;
  result.utime_us = cloud.utime_us;
  if (cloud.points.size() < kFewestMatchPoints) return result;
  result.state = LocalisationState::kTracking;
  result.modes.push_back({Pose2{}, Eigen::Matrix3d::Zero(), 0.0});
  result.confidence = 1.0;
  result.certified = true;
  return result;
}

Localisation Localiser::track(const Cloud& cloud, const std::optional<Pose2>& T_odom_base,
                              double& fit) {
  const Pose2 predicted = track_->predict(cloud.utime_us, T_odom_base);
  const double moved_m = distance_m(predicted, track_->pose),
               turned_rad = turn_rad(predicted, track_->pose);
  const double half_m = kWindow_m + kWindowShare * moved_m;
  Match match = matcher().match(
      cloud, PoseWindow{predicted, half_m, half_m, kWindow_rad + kWindowShare * turned_rad});
  const auto best_fit = [](const Match& m) { return m.modes.empty() ? 0.0 : m.modes.front().fit; };
  if (track_->fit == 0.0 || best_fit(match) < kDoubtfulFitShare * track_->fit) {
    const double dt_s =
        std::clamp(static_cast<double>(cloud.utime_us - track_->utime_us) * 1e-6, 0.1, 3.0);
    const double reach_m = half_m + config_.max_speed_mps * dt_s;
    const double reach_rad = kWindow_rad + config_.max_turn_rate_dps * kRadiansPerDegree * dt_s;
    const Match wide = matcher().match(cloud, PoseWindow{predicted, reach_m, reach_m, reach_rad});
    match.modes.insert(match.modes.end(), wide.modes.begin(), wide.modes.end());
    match.certified = match.certified && wide.certified;
    match.complete = match.complete && wide.complete;
    match.poses_examined += wide.poses_examined;
  }

  Localisation result = from_match(cloud, match);
  if (result.modes.empty()) return result;
  std::size_t best = 0;
  const Prior& prior = track_->T_odom_base && T_odom_base ? kOdometry : kGuess;
  const auto score = [&](std::size_t i) {
    return match.modes[i].fit - prior_cost(match.modes[i].pose, predicted, prior);
  };
  for (std::size_t i = 1; i < match.modes.size(); ++i) {
    if (score(i) > score(best)) best = i;
  }
  fit = match.modes[best].fit;
  put_first(result, best);
  const bool fits =
      match.modes[best].overlap >= kTrackOverlap && fit >= kTrackFitShare * track_->fit;
  result.state = fits ? LocalisationState::kTracking : LocalisationState::kLost;
  result.confidence = fits ? 0.9 + 0.1 * std::min(1.0, fit / std::max(track_->fit, 1e-9)) : 0.0;
  return result;
}

Localisation Localiser::locate(const Cloud& cloud, double& fit) {
  const Match match = matcher().match(cloud, std::nullopt);
  Localisation result = from_match(cloud, match);
  result.global = true;
  if (result.modes.empty() || match.modes.front().overlap < kLostOverlap) return result;
  fit = match.modes.front().fit;
  const bool sure =
      match.complete && match.rivalry <= 1.0 && match.modes.front().overlap >= kSureOverlap;
  result.state = sure ? LocalisationState::kTracking : LocalisationState::kAmbiguous;
  result.confidence = confidence_of(match.rivalry);
  return result;
}

void Localiser::remember(const Cloud& cloud, const std::optional<Pose2>& T_odom_base,
                         const Pose2& pose, double fit) {
  Track next;
  next.utime_us = cloud.utime_us;
  next.pose = pose;
  next.T_odom_base = T_odom_base;
  next.fit = fit;
  if (track_) {
    next.step = track_->pose.inverse() * pose;
    next.step_s = static_cast<double>(cloud.utime_us - track_->utime_us) * 1e-6;
  }
  track_ = std::make_unique<Track>(next);
}

}  // namespace voxlist
