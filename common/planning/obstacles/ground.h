#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/planning/obstacles/local_grid.h"
#include "voxlist/planning/obstacles/obstacle_config.h"
#include "voxlist/planning/rays/ray_window.h"

namespace voxlist::planning {

/// The floor round the robot, cell by cell of a grid, in base.
struct LocalFloor {
  /// Whether the cell's lowest point is floor.
  std::vector<std::uint8_t> is_floor;

  /// Height of the nearest floor (m), and how far away that is: what the cell's own would be.
  std::vector<float> height_m, away_m;
};

/// How far one place of the floor may be above or below another.
class FloorRule {
 public:
  explicit FloorRule(const ObstacleConfig& config);

  /// `apart_m`: between the places; `range_m`: of the farther one from the robot, which rocks
  /// between two looks.
  float most_m(float apart_m, float range_m) const {
    return step_m_ + slope_ * apart_m + rocking_m(range_m);
  }

  /// What of it is the robot's rocking.
  float rocking_m(float range_m) const { return rocking_ * range_m; }

 private:
  float step_m_, slope_, rocking_;
};

/// Whether the ray's own line saw it end below the floor: the floor beside its end is nearer to the
/// wheels' plane than its end is. Beside a low box it is the end that is on the floor.
bool is_below_floor(const Ray& ray, const ObstacleConfig& config);

/// Height of the lowest point in each cell (m), those below the floor left out; infinity: none.
std::vector<float> lowest_points(const LocalGrid& grid, const std::vector<Ray>& rays,
                                 const ObstacleConfig& config);

/// Finds the floor: the largest surface from the wheels on that is nowhere steeper than FloorRule
/// allows. The cells' lowest points join it one by one, first those that differ least from one
/// beside them that is in it, then those beyond a strip of up to gap_m where a ramp would go
/// on so; and none that is too high above or too low below what is in it already. So the floor
/// beside a box is there before the box's top, and the road below a kerb is not reached from the
/// kerb. `remembered`: cells that are floor at a height, NaN where not known; empty: none.
LocalFloor find_ground(const LocalGrid& grid, const std::vector<Ray>& rays,
                       const std::vector<float>& remembered, const ObstacleConfig& config);

}  // namespace voxlist::planning
