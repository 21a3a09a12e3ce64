#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace voxlist::planning {

/// What stands in the robot's way: from the floor on, hanging with free space below, or a drop.
enum class ObstacleType { kObstacle, kOverhang, kNegative };

inline constexpr int kObstacleTypes = 3;

/// Centre of a cell of the grid (m), in base.
struct ObstacleCell {
  Eigen::Vector2f centre;
  ObstacleType type;
};

/// Something that moves, or has come to where nothing was and stands (velocity 0). Base frame; the
/// velocity is over ground, on base's axes.
struct MovingObstacle {
  Eigen::Vector2f position;
  Eigen::Vector2f velocity_mps;
  float radius_m;
};

/// What there is round the robot, in base at `utime_us`.
struct ObstacleScan {
  std::int64_t utime_us = 0;

  /// Sector i is centred on bearing i * step_rad, counter-clockwise from forward (+x).
  double step_rad = 0.0;

  /// Each type has the horizontal distance from the frame's origin to its nearest one of each
  /// sector; infinity: none seen.
  std::array<std::vector<float>, kObstacleTypes> nearest_m;

  /// For each sector: up to here the floor is confirmed, from the robot on. 0: none of it is.
  std::vector<float> ground_seen_to_m;

  /// Cells that hold an obstacle, ordered by x, then y; of several types in one cell the first.
  std::vector<ObstacleCell> cells;

  std::vector<MovingObstacle> moving;

  const std::vector<float>& nearest(ObstacleType type) const {
    return nearest_m[static_cast<std::size_t>(type)];
  }
};

}  // namespace voxlist::planning
