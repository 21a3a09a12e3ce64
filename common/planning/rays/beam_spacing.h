#pragma once

#include <deque>

#include "voxlist/geometry/cloud.h"

namespace voxlist::planning {

/// How far apart a scanner's beams are in elevation, measured from its own clouds: the mirror
/// scanner's lines (4.8 deg at one sweep a second), or a laser's rings.
class BeamSpacing {
 public:
  /// Takes a cloud or a slice. One that has less than two beams below each other tells nothing.
  void add(const Cloud& cloud_base);

  /// The median of what the last clouds told (rad); the least that is told apart before any did.
  double spacing_rad() const;

 private:
  std::deque<double> medians_rad_;
};

/// The horizontal distance at which the beam `spacing_rad` above the one that meets the floor at
/// `from_m` meets it; infinity where it does not. `height_m`: of the scanner above the floor.
double next_on_floor_m(double from_m, double height_m, double spacing_rad);

}  // namespace voxlist::planning
