#pragma once

#include <optional>
#include <string>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/tilt.h"

namespace voxlist::matching {

/// The floor that a scan stands on, as a plane.
struct Floor {
  /// T_level_base that makes the floor level, and puts it at z = 0.
  Tilt level;
  /// Standard deviation of roll and pitch (rad), by what the floor is uneven by.
  double sigma_rad = 0.0;
  /// Squares of 0.5 m whose lowest points lie on the plane, as a share of all that show a surface,
  /// 0.5..1.
  double agreement = 0.0;

  /// The angle (rad) that the floor leans by in base.
  double lean_rad() const { return voxlist::lean_rad(level); }
  /// The floor's height under base (m): 0 where base is on the floor, as it should be.
  double height_m() const { return -level.z_m; }
};

/// Fits a plane to the lowest surfaces of a scan within 10 m. Nothing where half of them disagree
/// (stairs, ramps, holes in the floor), where the plane is steeper than 30 deg or above where the
/// rays start (a ceiling), or where too little of it is in sight. About 0.3 ms for 12,000 points.
std::optional<Floor> find_floor(const Cloud& cloud);

/// What is wrong with a floor where base should be on it and level: "floor tilted by 9.8 deg, 0.61
/// m low: is the mount set?". Empty below 2 deg and 0.1 m.
std::string what_is_off(const Floor& floor);

}  // namespace voxlist::matching
