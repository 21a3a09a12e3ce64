#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "voxlist/system/check.h"
#include "voxlist/voxels/voxel.h"

namespace voxlist {

/// One axis of a ray's way through the lattice. Time runs from 0 at its start to kEnd at its end,
/// in integers: the way has as many faces as lie between the ends, whatever is rounded.
struct RayAxis {
  static constexpr std::int64_t kEnd = std::int64_t{1} << 52;

  std::int32_t at, step;
  std::int64_t faces;    ///< left to cross at the start
  std::int64_t next;     ///< when the next face is met: until kEnd while one is left, then later
  std::int64_t between;  ///< time from face to face

  RayAxis(double from_m, double to_m, std::int32_t first, std::int32_t last, double resolution_m)
      : at(first), step(last < first ? -1 : 1), faces(std::abs(std::int64_t{last} - first)) {
    if (faces == 0) {
      next = kEnd + 1;
      between = 0;
      return;
    }
    constexpr double kScale = kEnd;
    const double way_m = to_m - from_m;
    const double face_m = (first + (step > 0 ? 1 : 0)) * resolution_m;
    // One face alone may be crossed at a crawl: all that counts then is that no second one follows.
    between = static_cast<std::int64_t>(std::min(resolution_m / std::abs(way_m), 1.0) * kScale) + 1;
    next = static_cast<std::int64_t>(std::clamp((face_m - from_m) / way_m, 0.0, 1.0) * kScale);
    next = std::clamp(next, kEnd + 1 - faces * between, kEnd - (faces - 1) * between);
  }

  /// All ones where this axis' next face is met before the other's, else 0.
  std::int64_t before(const RayAxis& other) const { return (next - other.next) >> 63; }

  /// Crosses the next face where `now` is all ones; does nothing where it is 0.
  void cross(std::int64_t now) {
    at += step & static_cast<std::int32_t>(now);
    next += between & now;
  }
};

/// Calls visit(Voxel) for the voxels of edge `resolution_m` that the straight way from `from` to
/// `to` (m) goes through, in order, each a face's neighbour of the one before, both ends included,
/// until visit returns false (Amanatides and Woo's traversal). Precondition: both ends are in the
/// lattice.
template <class Visit>
void visit_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double resolution_m,
               const Visit& visit) {
  VOXLIST_CHECK(in_lattice(from, resolution_m) && in_lattice(to, resolution_m),
                "a ray's ends must be in the lattice");
  const Voxel first = voxel_at(from, resolution_m), last = voxel_at(to, resolution_m);
  RayAxis x(from.x(), to.x(), first.x, last.x, resolution_m);
  RayAxis y(from.y(), to.y(), first.y, last.y, resolution_m);
  RayAxis z(from.z(), to.z(), first.z, last.z, resolution_m);
  std::int64_t faces = x.faces + y.faces + z.faces;
  // Which axis comes next is as good as random: masks cost less than mispredicted branches.
  for (; visit(Voxel{x.at, y.at, z.at}) && faces > 0; --faces) {
    const std::int64_t xy = x.before(y), xz = x.before(z), yz = y.before(z);
    x.cross(xy & xz);
    y.cross(~xy & yz);
    z.cross(~xz & ~yz);
  }
}

}  // namespace voxlist
