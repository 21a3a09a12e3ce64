#pragma once

#include <Eigen/Core>
#include <cmath>
#include <compare>
#include <cstdint>
#include <string>

#include "voxlist/system/check.h"

namespace voxlist {

/// Edge of the finest voxels (m): the random error of the 3D scanner (paper, sections III and V).
inline constexpr double kFinestResolution_m = 0.02;

/// A cell of the voxel lattice: voxel k of edge e covers [k e, (k + 1) e) on each axis.
///
/// The paper rounds to the nearest lattice point; this lattice is the same one shifted by half a
/// voxel, so that voxels of every power-of-two resolution nest exactly and down-sampling has no
/// bias.
struct Voxel {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;

  auto operator<=>(const Voxel&) const = default;
};

/// Largest |coordinate| (in voxels) that maps accept: 84 km at 0.02 m, beyond which a point is an
/// outlier, not a place. Larger: keys of blocks (21 bits an axis) and of their corners would
/// overflow.
inline constexpr std::int32_t kVoxelLimit = 1 << 22;

/// Integer division that rounds down. Precondition: divisor > 0.
constexpr std::int32_t floor_div(std::int32_t value, std::int32_t divisor) {
  VOXLIST_CHECK(divisor > 0, "a divisor must be above 0");
  return value / divisor - (value % divisor < 0 ? 1 : 0);
}

/// The voxel that covers a point (m). Precondition: |coordinate| / resolution_m < 2^31.
template <class Point>
Voxel voxel_at(const Point& p, double resolution_m) {
  const auto cell = [&](double value) {
    VOXLIST_CHECK(std::abs(value / resolution_m) < 2147483648.0,
                  "no voxel has coordinate " + std::to_string(value) + " m");
    return static_cast<std::int32_t>(std::floor(value / resolution_m));
  };
  return {cell(p.x()), cell(p.y()), cell(p.z())};
}

/// Centre of a voxel (m).
inline Eigen::Vector3d center(const Voxel& v, double resolution_m) {
  return Eigen::Vector3d(v.x + 0.5, v.y + 0.5, v.z + 0.5) * resolution_m;
}

/// Whether maps accept the point: finite and within kVoxelLimit voxels of the origin.
template <class Point>
bool in_lattice(const Point& p, double resolution_m) {
  const double limit_m = kVoxelLimit * resolution_m;
  return std::abs(p.x()) < limit_m && std::abs(p.y()) < limit_m && std::abs(p.z()) < limit_m;
}

}  // namespace voxlist
