#include <algorithm>

#include "voxlist/matching/floors/floor_view.h"
#include "voxlist/matching/floors/standing_heights.h"
#include "voxlist/matching/localisation/localiser.h"
#include "voxlist/matching/localisation/pose_track.h"
#include "voxlist/matching/localisation/reach_match.h"

// A robot that is followed may be on another floor by now: a lift carries it to where the walls are
// the same.

namespace voxlist::matching {
namespace {

// Points that are laid onto each floor.
constexpr std::size_t kFewPoints = 400;
// A floor is sure among all floors as it is where the whole map was searched
// (localiser_tilted.cpp).
constexpr double kSureAmongFloors = 0.996;
// A scan of which nearly nothing is farther away (m, as a share) shows a lift's cabin, or as little
// as one.
constexpr double kBox_m = 2.5, kNearlyNothing = 0.02;

bool is_boxed_in(const MatchPoints& points) {
  const auto beyond = std::count_if(points.points.begin(), points.points.end(), [](const auto& p) {
    return p.template head<2>().norm() > kBox_m;
  });
  return static_cast<double>(beyond) <= kNearlyNothing * static_cast<double>(points.points.size());
}

PoseMode mode_on(const FloorView& floor, double probability, PoseMode mode) {
  mode.T_map_base = to_pose2(floor.T_map_base);
  mode.tilt = tilt_of(floor.T_map_base);
  mode.probability *= probability;
  return mode;
}

// Adds the other floors to the modes.
void list_floors(const FloorBelief& belief, Localisation& result) {
  const std::vector<double> probabilities = belief.probabilities();
  const PoseMode followed = result.modes.front();
  for (PoseMode& mode : result.modes) mode.probability *= probabilities.front();
  for (std::size_t i = 1; i < probabilities.size(); ++i)
    result.modes.push_back(mode_on(belief.rivals()[i - 1].view, probabilities[i], followed));
  std::stable_sort(result.modes.begin(), result.modes.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  result.confidence = result.modes.front().probability;
}

}  // namespace

void Localiser::weigh_floors(const MatchPoints& points, Localisation& result) {
  if (result.confidence < kSureInReach) return;
  const PoseMode followed = result.modes.front();
  const Pose3 T_map_base = to_pose3(followed.T_map_base, followed.tilt);
  const MatchPoints few = some_of(points, kFewPoints);
  const auto others = views_of_others(matcher(), few, T_map_base,
                                      standing_heights_.about(map_, T_map_base.translation()));
  const FloorView here =
      others.empty() ? FloorView{T_map_base, 0.0} : view_near(matcher(), few, T_map_base);
  floor_belief_.weigh(result.utime_us, is_boxed_in(points), here, others);
  if (floor_belief_.probabilities().front() >= kSureAmongFloors) return;
  list_floors(floor_belief_, result);
  if (result.confidence >= kSureAmongFloors * followed.probability) {
    // The robot is followed on that floor from now on.
    track_->change_map(result.modes.front().T_map_base * followed.T_map_base.inverse());
    floor_belief_.clear();
  } else if (result.tracking()) {
    result.state = LocalisationState::kAmbiguous;
  }
}

}  // namespace voxlist::matching
