#pragma once

#include <vector>

#include "voxlist/geometry/cloud.h"

namespace voxlist::planning {

/// What the other points of its cloud say of a point.
struct Echo {
  bool is_wide = false;   ///< many are about it
  bool is_mixed = false;  ///< see Ray
};

/// Looks at each point of a cloud. Points of beams that follow each other are taken to be
/// neighbours in the cloud, too, as scanners send them. Cost: linear.
std::vector<Echo> look_at_echoes(const Cloud& cloud);

}  // namespace voxlist::planning
