#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>

#include "voxels/voxel.h"

namespace voxlist {

/// Calls visit(Voxel) for the voxels of edge `resolution_m` that the straight way from `from` to
/// `to` (m) goes through, in order, both ends included, until visit returns false (Amanatides and
/// Woo's traversal). Precondition: both ends are in the lattice.
template <class Visit>
void visit_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double resolution_m,
               const Visit& visit) {
  const Voxel first = voxel_at(from, resolution_m), last = voxel_at(to, resolution_m);
  std::array<std::int32_t, 3> at{first.x, first.y, first.z};
  const std::array<std::int32_t, 3> end{last.x, last.y, last.z};
  // Of the way's length: where the next face of each axis is met, and from one face to the next.
  std::array<double, 3> next{}, between{};
  std::array<std::int32_t, 3> step{};
  std::int64_t faces = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const double way = to[axis] - from[axis];
    step[i] = way > 0.0 ? 1 : -1;
    const double face = (at[i] + (way > 0.0 ? 1 : 0)) * resolution_m;
    const bool crosses = end[i] != at[i];
    next[i] = crosses ? (face - from[axis]) / way : std::numeric_limits<double>::infinity();
    between[i] = crosses ? resolution_m / std::abs(way) : 0.0;
    faces += std::abs(std::int64_t{end[i]} - at[i]);
  }
  for (; visit(Voxel{at[0], at[1], at[2]}) && faces > 0; --faces) {
    std::size_t axis = next[1] < next[0] ? 1 : 0;
    if (next[2] < next[axis]) axis = 2;
    at[axis] += step[axis];
    next[axis] = at[axis] == end[axis] ? std::numeric_limits<double>::infinity()
                                       : next[axis] + between[axis];
  }
}

}  // namespace voxlist
