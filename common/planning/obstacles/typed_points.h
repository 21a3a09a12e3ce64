#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/planning/obstacles/ground.h"
#include "voxlist/planning/obstacles/obstacle_scan.h"

namespace voxlist::planning {

/// A place in the robot's way, in base.
struct TypedPoint {
  Eigen::Vector3f point;
  ObstacleType type;
  std::size_t cell;
  std::int64_t utime_us;  ///< when it was seen
  bool came = false;      ///< something that was not there before

  Eigen::Vector2f place() const { return point.head<2>(); }
};

/// What stands or hangs between min_height_m and max_height_m above the ground: where rays ended.
/// A lone point counts within lone_within_m only, unless both its neighbours explain it. What is
/// low enough for a ramp from the nearest floor on, and not upright, may be one and is left out.
std::vector<TypedPoint> find_standing(const LocalGrid& grid, const std::vector<Ray>& rays,
                                      const LocalFloor& ground, const ObstacleConfig& config);

/// Where rays went down through the floor's level and ended below it, lower than slope and step
/// from the nearest floor explain: stairs down, kerbs, holes. The scanner's height and the distance
/// decide how many rays do: of a hole of length l at distance d, from height h, those
/// within atan(h / d) - atan(h / (d + l)). Each place is that edge of the floor before it which was
/// seen last. `until_us`: newer rays do not
/// count.
std::vector<TypedPoint> find_drops(const LocalGrid& grid, const std::vector<Ray>& rays,
                                   const LocalFloor& ground, const ObstacleConfig& config,
                                   std::int64_t until_us);

/// Where the floor goes on lower, as behind a kerb: by more than step_m and rocking_deg, and more
/// steeply than it falls before and behind the strip between, which the upper floor hides. A short
/// ramp between two levels looks the same until a beam meets it. Each place is the last of the
/// upper floor. `utime_us`: the time that they get.
std::vector<TypedPoint> find_steps_down(const LocalGrid& grid, const LocalFloor& ground,
                                        const ObstacleConfig& config, std::int64_t utime_us);

}  // namespace voxlist::planning
