#include "voxlist/matching/surfaces/surfel_fit.h"

#include <cmath>

#include "voxlist/geometry/elementary.h"
#include "voxlist/matching/surfaces/plane_fit.h"
#include "voxlist/matching/surfaces/surfel_side.h"
#include "voxlist/matching/surfaces/wall_faces.h"

namespace voxlist::matching {
namespace {

// Planes through fewer voxels than this are of few: twice the fewest that make a surface.
constexpr std::size_t kFewVoxels = 12;

// A plane whose shorter extent, as a standard deviation, is less (m) may be a line: twice a
// scanner's noise of 0.02 m, which smears a line along its rays. At 0.03 m a ceiling's scan lines
// still hold a robot in a corridor to where the map's first scan was taken.
constexpr double kLine_m = 0.04;

bool enough(std::span<const Voxel> voxels, const SurfelConfig& config) {
  return voxels.size() >= static_cast<std::size_t>(config.min_voxels);
}

CubeShape shape_of(const Plane& plane, double resolution_m, const SurfelConfig& config) {
  if (plane.deviations(0) * resolution_m > config.max_thickness_m) return CubeShape::kRough;
  // Without the lattice's own thickness a perfect plane would have infinite flatness.
  const double thickness = elementary::hypot(plane.deviations(0), std::sqrt(kLatticeVariance));
  return plane.deviations(1) >= config.min_flatness * thickness ? CubeShape::kSurface
                                                                : CubeShape::kTooFew;
}

// The variance of the direction (rad^2) of a line through n scattered points is the variance across
// it over n times the variance along it; the plane's shorter extent is the line.
double tilt_variance(const Plane& plane, std::size_t voxels) {
  const double across = plane.deviations(0) * plane.deviations(0) + kLatticeVariance,
               along = plane.deviations(1) * plane.deviations(1);
  return across / (along * static_cast<double>(voxels));
}

CubeShape make_surfel(const OccupancyMap& map, const Voxel& lowest, std::span<const Voxel> voxels,
                      const Plane& plane, const SurfelConfig& config, Surfel& surfel) {
  const double resolution_m = map.occupied.resolution_m();
  const CubeShape shape = shape_of(plane, resolution_m, config);
  if (shape != CubeShape::kSurface) return shape;
  const Eigen::Vector3d from(lowest.x, lowest.y, lowest.z);
  surfel = {(from + plane.mean + Eigen::Vector3d::Constant(0.5)) * resolution_m, plane.normal,
            tilt_variance(plane, voxels.size())};
  surfel.of_few_voxels = voxels.size() < kFewVoxels;
  surfel.of_line = plane.deviations(1) * resolution_m < kLine_m;
  find_side(map, voxels, lowest, surfel);
  return shape;
}

}  // namespace

CubeShape fit_surfels(const OccupancyMap& map, const Voxel& lowest, std::span<const Voxel> voxels,
                      const SurfelConfig& config, Surfel sides[2], int& count) {
  count = 0;
  if (!enough(voxels, config)) return CubeShape::kTooFew;
  const Plane plane = fit_plane(voxels);
  const std::optional<double> gap = find_gap(plane, voxels, map.occupied.resolution_m());
  if (!gap) {
    const CubeShape shape = make_surfel(map, lowest, voxels, plane, config, sides[0]);
    count = shape == CubeShape::kSurface;
    return shape;
  }
  std::vector<Voxel> faces[2];
  for (const Voxel& v : voxels) faces[plane.distance(v) < *gap ? 0 : 1].push_back(v);
  for (const auto& face : faces) {
    if (enough(face, config))
      count += make_surfel(map, lowest, face, fit_plane(face), config, sides[count]) ==
               CubeShape::kSurface;
  }
  return count > 0 ? CubeShape::kSurface : CubeShape::kTooFew;
}

}  // namespace voxlist::matching
