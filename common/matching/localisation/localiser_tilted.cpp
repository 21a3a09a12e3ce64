#include <algorithm>
#include <utility>

#include "voxlist/geometry/angle.h"
#include "voxlist/matching/localisation/localiser.h"
#include "voxlist/matching/localisation/lost_search.h"
#include "voxlist/matching/localisation/pose_track.h"

// Clouds that are tilted: each is made level by what is known of its tilt, and located as level
// ones are. Where the map's surfaces say there that it still leans, that is taken out, too, and the
// cloud is located again: so search, evidence and confidence are those of a level cloud.

namespace voxlist::matching {
namespace {

// A cloud is level enough when this (rad, m) is left of its tilt: far below what evidence forgives.
constexpr double kLevel_rad = 0.2 * kRadPerDeg, kLevel_m = 0.02;
// What floors and the last cloud may be wrong by (rad, m): surfaces that say more are the wrong
// ones.
constexpr double kFarthest_rad = 4.0 * kRadPerDeg, kFarthest_m = 0.3;
// Most times that a cloud is located; two are usual where it has turned a good deal.
constexpr int kMostTimes = 3;
// Most places at which a cloud's tilt is asked for when nothing is expected.
constexpr std::size_t kMostPlaces = 8;
// Points that choose between guesses.
constexpr std::size_t kFewPoints = 400;

bool are_near(const Tilt& a, const Tilt& b, double off_rad, double off_m) {
  return std::abs(a.z_m - b.z_m) < off_m && std::abs(a.roll_rad - b.roll_rad) < off_rad &&
         std::abs(a.pitch_rad - b.pitch_rad) < off_rad;
}

}  // namespace

struct Localiser::Belief {
  std::unique_ptr<PoseTrack> track;
  std::unique_ptr<LostSearch> search;
  OdometryCheck odometry_check;
};

Localiser::Belief Localiser::belief() const {
  return {track_ ? std::make_unique<PoseTrack>(*track_) : nullptr,
          search_ ? std::make_unique<LostSearch>(*search_) : nullptr, odometry_check_};
}

void Localiser::believe(Belief belief) {
  track_ = std::move(belief.track);
  search_ = std::move(belief.search);
  odometry_check_ = std::move(belief.odometry_check);
}

Localisation Localiser::locate_at(const Cloud& cloud, const Tilt& tilt, const Locate& locate) {
  const Cloud level = moved(to_level(tilt), cloud);
  Localisation result = locate(PreparedScan(level, config_.matcher.scan));
  for (PoseMode& mode : result.modes) mode.tilt = tilt;
  return result;
}

Localisation Localiser::locate_tilted(const Cloud& cloud, const KnownTilt& known,
                                      const std::optional<Pose2>& expected, const Locate& locate) {
  if (map_.empty()) return locate_at(cloud, Levelling::of_origin(known), locate);
  const MatchPoints points = PreparedScan(cloud, config_.matcher.scan).spatial_points();
  const Tilt first = expected ? expected_tilt(points, known, *expected)
                              : searched_tilt(cloud, points, known, locate);
  Tilt tilt = first;
  for (int time = 1;; ++time) {
    Belief before = belief();
    Localisation result = locate_at(cloud, tilt, locate);
    if (result.modes.empty()) return result;
    PoseMode& best = result.modes.front();
    const Tilt now = refined_tilt(points, best.T_map_base, tilt).tilt;
    if (!are_near(now, first, kFarthest_rad, kFarthest_m)) return result;
    if (time == kMostTimes || are_near(now, tilt, kLevel_rad, kLevel_m)) {
      best.tilt = now;
      return result;
    }
    believe(std::move(before));
    tilt = now;
  }
}

Localiser::RefinedTilt Localiser::refined_tilt(const MatchPoints& points, const Pose2& place,
                                               const Tilt& start) {
  const SpatialRefinement refined = matcher().refined_in_space(points, to_pose3(place, start));
  const Tilt now = tilt_of(refined.pose);
  const bool is_near = are_near(now, start, kFarthest_rad, kFarthest_m);
  return {is_near ? now : start, is_near ? refined.inlier_ratio : 0.0};
}

// Where the robot is expected, the map's surfaces choose among what is known.
Tilt Localiser::expected_tilt(const MatchPoints& points, const KnownTilt& known,
                              const Pose2& expected) {
  const std::vector<Tilt> guesses = levelling_.guesses(known);
  const MatchPoints few = some_of(points, kFewPoints);
  RefinedTilt best{guesses.back(), 0.0};
  for (const Tilt& guess : guesses) {
    const RefinedTilt now = refined_tilt(few, expected, guess);
    if (now.inlier_ratio > best.inlier_ratio) best = now;
  }
  return best.tilt;
}

// Where nothing is expected, the cloud is searched for at each height that it may have.
Tilt Localiser::searched_tilt(const Cloud& cloud, const MatchPoints& points, const KnownTilt& known,
                              const Locate& locate) {
  levelling_.look_at(map_);
  RefinedTilt best;
  for (const Tilt& guess : levelling_.guesses_anywhere(known)) {
    Belief before = belief();
    const Localisation found = locate_at(cloud, guess, locate);
    believe(std::move(before));
    const RefinedTilt now = tilt_by_modes(points, known, found);
    if (now.inlier_ratio > best.inlier_ratio) best = now;
  }
  return best.tilt;
}

// At each of the likeliest places, the cloud's floor is laid onto the map's; where most points then
// lie on surfaces, the cloud is tilted like that.
Localiser::RefinedTilt Localiser::tilt_by_modes(const MatchPoints& points, const KnownTilt& known,
                                                const Localisation& found) {
  const MatchPoints few = some_of(points, kFewPoints);
  RefinedTilt best;
  for (std::size_t i = 0; i < std::min(kMostPlaces, found.modes.size()); ++i) {
    const PoseMode& mode = found.modes[i];
    const auto on_floor =
        known.floor ? floor_on_floor(map_, mode.T_map_base, *known.floor) : std::nullopt;
    const RefinedTilt now = refined_tilt(few, mode.T_map_base, on_floor.value_or(mode.tilt));
    if (now.inlier_ratio > best.inlier_ratio) best = now;
  }
  return best;
}

}  // namespace voxlist::matching
