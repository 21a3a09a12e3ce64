#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/planning/obstacles/ground.h"

namespace voxlist::planning {

/// What decides how wide a strip of floor lies between two beams.
struct BeamGeometry {
  double height_m = 0.0;  ///< of the scanner above the floor
  double spacing_rad = 0.0;
};

/// Tells for each bearing how far the floor is confirmed from the robot on (m): until a cell that
/// is `blocked`, or one of `drops` or beside it, or a strip without floor that is wider than one
/// and a half beams' spacing explains at its distance, or than gap_m. The first strip may be as
/// wide as the robot hides, unseen_near_m.
std::vector<float> floor_reach(const LocalGrid& grid, const LocalFloor& ground,
                               const std::vector<std::uint8_t>& blocked,
                               const std::vector<std::uint8_t>& drops, const BeamGeometry& beams,
                               const ObstacleConfig& config);

}  // namespace voxlist::planning
