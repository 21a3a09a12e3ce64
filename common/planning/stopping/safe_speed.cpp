#include "voxlist/planning/stopping/safe_speed.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"

namespace voxlist::planning {
namespace {

// The way to standstill is looked at in steps of this (s), half a beam's width at 1 m/s.
constexpr double kStep_s = 0.05;

// Speeds are told apart by a 32nd of the top speed.
constexpr int kHalvings = 5;

// The front edge of the robot is held against the floor's end at these bearings (rad).
constexpr double kFront_rad[] = {-0.7, 0.0, 0.7};

// Distances are compared up to this (m): a wall beside does not come nearer.
constexpr double kNearer_m = 0.002;

class StoppingWay {
 public:
  StoppingWay(const Surroundings& around, double turn_radps, const StoppingRobot& robot)
      : around_(around), turn_radps_(turn_radps), robot_(robot) {
    const double seconds =
        around.age_s + robot.reaction_s + robot.top_speed_mps / robot.brakes_mps2 + kStep_s;
    const double own_m =
        seconds * robot.top_speed_mps + robot.radius_m + robot.margin_m + robot.margin_s;
    for (const Thing& thing : around.things)
      if (thing.position.norm() - thing.radius_m <
          own_m + seconds * (thing.velocity_mps.norm() + thing.strays_mps))
        near_.push_back(thing);
  }

  // Whether the robot can drive on at a speed until its command is heard, and brake.
  bool is_free(double speed_mps) const {
    const double late_s = robot_.reaction_s + around_.age_s;
    const double margin_m = robot_.radius_m + robot_.margin_m + robot_.margin_s * speed_mps;
    Eigen::Vector2d place(0.0, 0.0);
    double heading_rad = 0.0, at_mps = speed_mps;
    for (double t_s = kStep_s; at_mps > 0.0; t_s += kStep_s) {
      const double before_mps = at_mps;
      if (t_s > late_s) at_mps = std::max(0.0, at_mps - robot_.brakes_mps2 * kStep_s);
      heading_rad += turn_radps_ * kStep_s;
      const auto [sine, cosine] = elementary::sine_cosine(heading_rad);
      place += (before_mps + at_mps) / 2.0 * kStep_s * Eigen::Vector2d(cosine, sine);
      if (!has_floor(place, heading_rad) || touches(place, margin_m, t_s)) return false;
    }
    return true;
  }

 private:
  bool touches(const Eigen::Vector2d& place, double margin_m, double t_s) const {
    return std::ranges::any_of(near_, [&](const Thing& thing) {
      const Eigen::Vector2d then = thing.position + t_s * thing.velocity_mps;
      const double keep_m = margin_m + thing.radius_m + t_s * thing.strays_mps;
      const double away_m = (then - place).norm();
      return away_m < keep_m && away_m < thing.position.norm() - kNearer_m;
    });
  }

  // The floor that it stands on bears it.
  bool has_floor(const Eigen::Vector2d& place, double heading_rad) const {
    return std::ranges::all_of(kFront_rad, [&](double aside_rad) {
      const auto [sine, cosine] = elementary::sine_cosine(heading_rad + aside_rad);
      const Eigen::Vector2d edge = place + robot_.radius_m * Eigen::Vector2d(cosine, sine);
      const double away_m = edge.norm();
      return away_m <= robot_.radius_m + kNearer_m || away_m <= seen_to_m(edge);
    });
  }

  double seen_to_m(const Eigen::Vector2d& place) const {
    const auto sectors = static_cast<std::ptrdiff_t>(around_.ground_seen_to_m.size());
    if (sectors == 0) return 0.0;
    const double turns = elementary::atan2(place.y(), place.x()) / around_.step_rad;
    const std::ptrdiff_t sector = (std::lround(turns) % sectors + sectors) % sectors;
    return static_cast<double>(around_.ground_seen_to_m[static_cast<std::size_t>(sector)]);
  }

  const Surroundings& around_;
  const double turn_radps_;
  const StoppingRobot& robot_;
  std::vector<Thing> near_;  // what it could reach
};

}  // namespace

double stopping_speed_mps(double gap_m, double late_s, double brakes_mps2) {
  if (gap_m <= 0.0) return 0.0;
  const double lost_mps = brakes_mps2 * late_s;
  return std::sqrt(lost_mps * lost_mps + 2.0 * brakes_mps2 * gap_m) - lost_mps;
}

double safe_speed_mps(const Surroundings& around, double turn_radps, const StoppingRobot& robot) {
  const double gap_m = around.steps_in_m - robot.radius_m - robot.margin_m;
  const double late_s = around.sweep_s + robot.reaction_s;
  double most_mps =
      std::min(robot.top_speed_mps, stopping_speed_mps(gap_m, late_s, robot.brakes_mps2));
  const StoppingWay way(around, turn_radps, robot);
  if (way.is_free(most_mps)) return most_mps;
  double free_mps = 0.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double between_mps = (free_mps + most_mps) / 2.0;
    (way.is_free(between_mps) ? free_mps : most_mps) = between_mps;
  }
  return free_mps;
}

}  // namespace voxlist::planning
