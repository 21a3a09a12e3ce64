#include "voxlist/matching/scan/flat_surfaces.h"

#include <algorithm>
#include <cmath>

#include "voxlist/geometry/elementary.h"
#include "voxlist/voxels/fast_cell.h"
#include "voxlist/voxels/numbering.h"

namespace voxlist::matching {
namespace {

// Edge of the cubes that are tested, in finest voxels: 0.32 m. With 0.16 and 0.64 m the medians of
// bench_tracking 40 1 are the same within 0.2 mm; with far larger cubes a table is one with the
// wall behind it.
constexpr std::int32_t kEdge = 16;
// Fewer points have no shape that is worth a test.
constexpr std::int64_t kFewestPoints = 6;
// Points that lie flat spread over the ground, in their narrow direction too, by more than this
// multiple of what they spread in height: slopes up to about 22 deg (1 / 2.5) count as flat.
constexpr double kFlatness = 2.5;
// They spread by less than this in height, as a standard deviation in finest voxels: 0.06 m. A
// third of it, or three times as much, leaves bench_tracking 40 1 as it is: kFlatness decides. It
// keeps cubes out that hold a floor and things on it.
constexpr double kThickest = 3.0;
// Variance of a coordinate that is rounded to whole voxels, in voxels squared.
constexpr double kRounding = 1.0 / 12.0;

// Sums over the points of a cube, in finest voxels from the cube's lowest: whole numbers, whose
// sums know no order.
struct Spread {
  std::int64_t n = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, yy = 0, zz = 0;

  void add(std::int64_t vx, std::int64_t vy, std::int64_t vz) {
    ++n;
    x += vx, y += vy, z += vz;
    xx += vx * vx, xy += vx * vy, yy += vy * vy, zz += vz * vz;
  }

  double covariance(std::int64_t ab, std::int64_t a, std::int64_t b) const {
    const auto count = static_cast<double>(n);
    return (static_cast<double>(ab) - static_cast<double>(a * b) / count) / count;
  }

  // Whether the points are wide both ways over the ground (a line of points on a wall is not), and
  // thin in height.
  bool flat() const {
    if (n < kFewestPoints) return false;
    const double vx = covariance(xx, x, x), vy = covariance(yy, y, y), vxy = covariance(xy, x, y);
    const double narrow = (vx + vy) / 2.0 - elementary::hypot((vx - vy) / 2.0, vxy);
    const double height = covariance(zz, z, z);
    return height < kThickest * kThickest && narrow > kFlatness * kFlatness * (height + kRounding);
  }
};

}  // namespace

std::vector<bool> on_flat_surfaces(std::span<const Eigen::Vector3f> points,
                                   std::span<const std::uint32_t> indices) {
  Numbering numbers(indices.size());
  std::vector<Spread> cubes;
  std::vector<std::uint32_t> cube_of;
  cube_of.reserve(indices.size());
  for (const std::uint32_t i : indices) {
    const Voxel v = cell_at(points[i], 1.0 / kFinestResolution_m);
    const Voxel cube{floor_div(v.x, kEdge), floor_div(v.y, kEdge), floor_div(v.z, kEdge)};
    const std::uint32_t number = numbers.number(key_of(cube));
    if (number == cubes.size()) cubes.emplace_back();
    cubes[number].add(v.x - cube.x * kEdge, v.y - cube.y * kEdge, v.z - cube.z * kEdge);
    cube_of.push_back(number);
  }
  std::vector<bool> flat_cubes, flat(points.size());
  for (const Spread& cube : cubes) flat_cubes.push_back(cube.flat());
  for (std::size_t k = 0; k < indices.size(); ++k) flat[indices[k]] = flat_cubes[cube_of[k]];
  return flat;
}

}  // namespace voxlist::matching
