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
// At the last time so much may be left (rad, m): what evidence forgives.
constexpr double kAlmost_rad = 1.0 * kRadPerDeg, kAlmost_m = 0.1;
// What floors and the last cloud may be wrong by (rad, m), where a ramp of 10 deg begins or ends
// between two clouds: surfaces that say more are the wrong ones.
constexpr double kFarthest_rad = 12.0 * kRadPerDeg, kFarthest_m = 0.3;
// Most times that a cloud is located; two are usual where it has turned a good deal.
constexpr int kMostTimes = 3;
// Most places at which a cloud's tilt is asked for when nothing is expected.
constexpr std::size_t kMostPlaces = 8;
// Floors are rivals where so much of what fits the best one fits them, too; most that are asked.
constexpr double kRivalRatio = 0.7;
constexpr std::size_t kMostFloors = 4;
// Two guesses are one when they differ by no more (rad, m).
constexpr double kSameTilt_rad = 1.0 * kRadPerDeg, kSameTilt_m = 0.1;
// A place is sure among those on all floors as it is among those on one (lost_search.cpp).
constexpr double kSureAmongFloors = 0.996;
// Points of a floor lie so near to its plane (m); so many of them are on the map's.
constexpr double kThick_m = 0.06, kMost = 0.5;
// Where that is not so, what was found has as probable a rival at another height.
constexpr double kHeightUnknown = 0.5;
// Points that choose between guesses.
constexpr std::size_t kFewPoints = 400;
// Guesses are told apart where at least so much of a cloud lies on surfaces: less does anywhere.
constexpr double kTells = 0.3;

bool are_near(const Tilt& a, const Tilt& b, double off_rad, double off_m) {
  return std::abs(a.z_m - b.z_m) < off_m && std::abs(a.roll_rad - b.roll_rad) < off_rad &&
         std::abs(a.pitch_rad - b.pitch_rad) < off_rad;
}

double odds_of(double probability) {
  constexpr double kNearlyOne = 1.0 - 1e-9;
  return probability / (1.0 - std::min(probability, kNearlyOne));
}

// What was found is right with this share of its probability.
void doubt(double share, Localisation& found) {
  found.confidence *= share;
  for (PoseMode& mode : found.modes) mode.probability *= share;
  if (found.tracking() && found.confidence < kSureAmongFloors)
    found.state = LocalisationState::kAmbiguous;
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
  Localisation result = locate(PreparedScan(level, config_.matcher.scan, tilt.z_m));
  for (PoseMode& mode : result.modes) mode.tilt = tilt;
  return result;
}

Localisation Localiser::locate_tilted(const Cloud& cloud, const KnownTilt& known,
                                      const std::optional<Pose2>& expected, const Locate& locate) {
  if (map_.empty()) return locate_at(cloud, Levelling::of_origin(known), locate);
  const MatchPoints points = spatial_points(cloud);
  if (expected) {
    Belief before = belief();
    Localisation result =
        located_from(cloud, points, expected_tilt(cloud, points, known, *expected, locate), locate);
    if (!result.searched_whole_map) {
      if (jumps(result)) {
        believe(std::move(before));
        return not_level(std::move(result));
      }
      weigh_floors(points, result);
      return result;
    }
    believe(std::move(before));
  }
  Localisation result = located_anywhere(cloud, points, known, locate);
  if (result.tracking()) floor_belief_.clear();
  return result;
}

// At all heights: it is the floor that tells height, roll and pitch.
MatchPoints Localiser::spatial_points(const Cloud& cloud) const {
  ScanConfig config = config_.matcher.scan;
  config.match_heights_m.clear();
  return PreparedScan(cloud, config).spatial_points();
}

// Whether it was found at a height that the robot's way does not lead to.
bool Localiser::jumps(const Localisation& found) const {
  return !found.modes.empty() &&
         !levelling_.reaches(found.modes.front().T_map_base, found.modes.front().tilt);
}

// Locates a cloud that is tilted about like this.
Localisation Localiser::located_from(const Cloud& cloud, const MatchPoints& points,
                                     const Tilt& first, const Locate& locate) {
  Tilt tilt = first;
  for (int time = 1;; ++time) {
    Belief before = belief();
    Localisation result = locate_at(cloud, tilt, locate);
    if (result.modes.empty()) return result;
    PoseMode& best = result.modes.front();
    const RefinedTilt now = refined_tilt(points, best.T_map_base, tilt);
    const bool is_last = time == kMostTimes;
    const bool is_level =
        now.is_near && are_near(now.tilt, tilt, is_last ? kAlmost_rad : kLevel_rad,
                                is_last ? kAlmost_m : kLevel_m);
    if (is_level) best.tilt = now.tilt;
    if (is_level) return result;
    believe(std::move(before));
    const bool goes_on = now.is_near && are_near(now.tilt, first, kFarthest_rad, kFarthest_m);
    if (!goes_on || is_last) return not_level(std::move(result));
    tilt = now.tilt;
  }
}

// The robot may be on any of the map's floors: a place that is found on one of them has its rivals
// on the others.
Localisation Localiser::located_anywhere(const Cloud& cloud, const MatchPoints& points,
                                         const KnownTilt& known, const Locate& locate) {
  const Belief before = belief();
  Belief after;
  Localisation best;
  double odds = 0.0;
  const auto copy = [](const Belief& belief) {
    return Belief{belief.track ? std::make_unique<PoseTrack>(*belief.track) : nullptr,
                  belief.search ? std::make_unique<LostSearch>(*belief.search) : nullptr,
                  belief.odometry_check};
  };
  for (const Tilt& tilt : searched_tilts(cloud, points, known, locate)) {
    believe(copy(before));
    Localisation found = located_from(cloud, points, tilt, locate);
    if (found.searched_whole_map && !stands_on_floor(points, known, found)) {
      believe(copy(before));
      doubt(kHeightUnknown, found);
    }
    odds += odds_of(found.confidence);
    if (!best.modes.empty() && found.confidence <= best.confidence) continue;
    best = std::move(found);
    after = belief();
  }
  if (best.modes.empty()) return best;
  // A place's probability on its floor shrinks to this share of it among all floors.
  const double share = (1.0 + odds_of(best.confidence)) / (1.0 + odds);
  const bool was_sure = best.tracking();
  if (share < 1.0) doubt(share, best);
  believe(was_sure && !best.tracking() ? copy(before) : std::move(after));
  return best;
}

// Walls are the same at any height: a robot is at the height that was found where the floor that
// it stands on is on the map's.
bool Localiser::stands_on_floor(const MatchPoints& points, const KnownTilt& known,
                                const Localisation& found) {
  if (!known.floor || found.modes.empty()) return false;
  const Pose3 T_level_base = to_level(known.floor->level);
  MatchPoints floor;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    if (std::abs((T_level_base * points.points[i].cast<double>()).z()) > kThick_m) continue;
    floor.points.push_back(points.points[i]);
    if (!points.origins.empty()) floor.origins.push_back(points.origins[i]);
  }
  const PoseMode& best = found.modes.front();
  const Pose3 T_map_base = to_pose3(best.T_map_base, best.tilt);
  return matcher().refined_in_space(floor, T_map_base).inlier_ratio >= kMost;
}

// The cloud was located as if it were level, and the surfaces there say that it is not.
Localisation Localiser::not_level(Localisation result) {
  if (result.tracking()) result.state = LocalisationState::kAmbiguous;
  result.confidence = 0.0;
  for (PoseMode& mode : result.modes) mode.probability = 0.0;
  if (track_) track_->doubt(0.0);
  return result;
}

Localiser::RefinedTilt Localiser::refined_tilt(const MatchPoints& points, const Pose2& place,
                                               const Tilt& start) {
  const SpatialRefinement refined = matcher().refined_in_space(points, to_pose3(place, start));
  const Tilt now = tilt_of(refined.pose);
  const bool is_near = are_near(now, start, kFarthest_rad, kFarthest_m);
  return {is_near ? now : start, is_near ? refined.inlier_ratio : 0.0, is_near};
}

// Where the robot is expected, the map's surfaces choose among what is known. Where it turns out
// that it is not there, as when it ends a turn and no odometry says so, walls tell its place first.
Tilt Localiser::expected_tilt(const Cloud& cloud, const MatchPoints& points, const KnownTilt& known,
                              const Pose2& expected, const Locate& locate) {
  const RefinedTilt best = best_guess(points, known, expected);
  if (best.inlier_ratio >= kTells) return best.tilt;
  const Tilt last = levelling_.guesses(known, expected).front();
  Belief before = belief();
  const Localisation found = locate_at(cloud, last, locate);
  believe(std::move(before));
  return found.modes.empty() ? best.tilt
                             : best_guess(points, known, found.modes.front().T_map_base).tilt;
}

Localiser::RefinedTilt Localiser::best_guess(const MatchPoints& points, const KnownTilt& known,
                                             const Pose2& place) {
  const std::vector<Tilt> guesses = levelling_.guesses(known, place);
  const MatchPoints few = some_of(points, kFewPoints);
  const Tilt& last = guesses.front();
  RefinedTilt best{last};
  for (const Tilt& guess : guesses) {
    if (&guess != &last && are_near(guess, last, kSameTilt_rad, kSameTilt_m)) continue;
    const RefinedTilt now = refined_tilt(few, place, guess);
    if (now.inlier_ratio > best.inlier_ratio && levelling_.reaches(place, now.tilt)) best = now;
  }
  return best;
}

// Where nothing is expected, the cloud is searched for at each height that it may have; those come
// first at which most of it then lies on surfaces.
std::vector<Tilt> Localiser::searched_tilts(const Cloud& cloud, const MatchPoints& points,
                                            const KnownTilt& known, const Locate& locate) {
  levelling_.look_at(map_);
  std::vector<RefinedTilt> refined;
  for (const Tilt& guess : levelling_.guesses_anywhere(known)) {
    Belief before = belief();
    const Localisation found = locate_at(cloud, guess, locate);
    believe(std::move(before));
    refined.push_back(tilt_by_modes(points, known, found));
  }
  std::stable_sort(refined.begin(), refined.end(), [](const RefinedTilt& a, const RefinedTilt& b) {
    return a.inlier_ratio > b.inlier_ratio;
  });
  std::vector<Tilt> tilts;
  for (const RefinedTilt& tilt : refined) {
    const bool is_new = std::none_of(tilts.begin(), tilts.end(), [&](const Tilt& other) {
      return are_near(tilt.tilt, other, kSameTilt_rad, kSameTilt_m);
    });
    const bool fits = tilt.inlier_ratio >= kRivalRatio * refined.front().inlier_ratio;
    if (is_new && fits && tilts.size() < kMostFloors) tilts.push_back(tilt.tilt);
  }
  return tilts;
}

// At each of the likeliest places, the cloud's floor is laid onto the map's; where most points then
// lie on surfaces, the cloud is tilted like that.
Localiser::RefinedTilt Localiser::tilt_by_modes(const MatchPoints& points, const KnownTilt& known,
                                                const Localisation& found) {
  const MatchPoints few = some_of(points, kFewPoints);
  RefinedTilt best;
  for (std::size_t i = 0; i < std::min(kMostPlaces, found.modes.size()); ++i) {
    const PoseMode& mode = found.modes[i];
    const auto on_floor = known.floor
                              ? floor_on_floor(map_, mode.T_map_base, mode.tilt.z_m, *known.floor)
                              : std::nullopt;
    const RefinedTilt now = refined_tilt(few, mode.T_map_base, on_floor.value_or(mode.tilt));
    if (now.inlier_ratio > best.inlier_ratio) best = now;
  }
  return best;
}

}  // namespace voxlist::matching
