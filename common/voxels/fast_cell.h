#pragma once

#include "voxlist/voxels/voxel.h"

namespace voxlist {

/// The cell of a point on a lattice with `per_m` cells a metre: voxel_at() without its divisions
/// and calls of floor, for loops over points. A point within rounding of a face may fall on either
/// side of it.
template <class Point>
Voxel cell_at(const Point& p, double per_m) {
  const auto cell = [per_m](double value) {
    const double scaled = value * per_m;
    const auto whole = static_cast<std::int32_t>(scaled);
    return whole - (scaled < whole ? 1 : 0);
  };
  return {cell(p.x()), cell(p.y()), cell(p.z())};
}

}  // namespace voxlist
