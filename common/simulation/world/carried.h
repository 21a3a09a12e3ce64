#pragma once

#include <vector>

#include "voxlist/simulation/world/trajectory.h"

namespace voxlist::simulation {

/// Somebody carries the robot off: at each time it stands somewhere else, and the wheels, which
/// stand still, measure nothing of it. It looks along x there. All lists are as long.
struct CarriedConfig {
  std::vector<double> at_s;  ///< ascending; none: nobody does
  std::vector<double> x_m, y_m;
  double back_at_s = 0.0;  ///< it is put back where it was, and drives on; 0: never
};

/// What the wheels feel of a motion that is so interrupted: they stand from the first time on.
Trajectory without_carries(const Trajectory& driven, const CarriedConfig& config);

/// The motion with all places where the robot stands. Throws std::invalid_argument for lists and
/// times that do not fit together.
Trajectory with_carries(const Trajectory& driven, const CarriedConfig& config);

}  // namespace voxlist::simulation
