#pragma once

#include <cstddef>

#include "voxlist/geometry/cloud.h"

namespace voxlist {

/// Whether point i is a hit at a range (m) between these. 0,0,0 is none: it stands for "nothing
/// came back", as does a point on the start of its ray.
inline bool is_within(const Cloud& cloud, std::size_t i, double min_range_m, double max_range_m) {
  const Eigen::Vector3f ray = cloud.points[i] - cloud.origin(i);
  const auto range_m = static_cast<double>(ray.norm());
  return !cloud.points[i].isZero(0.0F) && range_m > 0.0 && range_m >= min_range_m &&
         range_m <= max_range_m;
}

}  // namespace voxlist
