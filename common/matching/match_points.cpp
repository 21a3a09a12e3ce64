#include "matching/match_points.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "matching/surfels.h"
#include "voxels/voxel_map.h"

namespace voxlist {
namespace {

using Points = std::vector<Eigen::Vector3f>;

double horizontal_range_m(const Eigen::Vector3f& p) {
  return std::hypot(double(p.x()), double(p.y()));
}

bool lexicographic(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

// The points that are within range and do not belong to a flat-lying surface; all within range when
// these are few.
Points informative_points(std::span<const Eigen::Vector3f> points,
                          const MatchPointsConfig& config) {
  constexpr double kFlat = 0.9;         // |z| of the normal: slopes up to 26 deg count as flat
  constexpr double kFewestKept = 0.05;  // of all points
  Points in_range;
  VoxelMap voxels;
  for (const auto& p : points) {
    if (!in_lattice(p, voxels.resolution_m()) || horizontal_range_m(p) > config.max_range_m)
      continue;
    in_range.push_back(p);
    voxels.insert(voxel_at(p, voxels.resolution_m()));
  }
  const SurfelMap surfels(voxels, {.cell_m = config.flat_cube_m});
  Points upright;
  for (const auto& p : in_range) {
    const Surfel* surfel = surfels.find(p.cast<double>());
    if (!surfel || std::abs(surfel->normal.z()) < kFlat) upright.push_back(p);
  }
  const auto fewest = static_cast<std::size_t>(kFewestKept * static_cast<double>(in_range.size()));
  return upright.size() > fewest ? upright : in_range;
}

// One point of each cube: the lexicographically first, sorted by cube.
std::map<std::int32_t, Points> one_per_cube(std::span<const Eigen::Vector3f> points,
                                            const MatchPointsConfig& config) {
  std::vector<std::pair<Voxel, Eigen::Vector3f>> in_cubes;
  in_cubes.reserve(points.size());
  for (const auto& p : points) {
    in_cubes.emplace_back(voxel_at(p, config.spacing_m), p);
  }
  std::sort(in_cubes.begin(), in_cubes.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : lexicographic(a.second, b.second);
  });
  std::map<std::int32_t, Points> layers;
  for (std::size_t i = 0; i < in_cubes.size(); ++i) {
    if (i == 0 || in_cubes[i].first != in_cubes[i - 1].first)
      layers[in_cubes[i].first.z].push_back(in_cubes[i].second);
  }
  return layers;
}

// The largest cap on a layer's points that keeps the total within max_points, and no layer far
// above the usual one: walls give each layer a line of points, a floor or a ceiling gives its own a
// whole area.
std::size_t layer_cap(const std::map<std::int32_t, Points>& layers, std::size_t max_points) {
  constexpr double kAboveUsual = 1.5;
  std::vector<std::size_t> counts;
  for (const auto& [z, points] : layers) counts.push_back(points.size());
  if (counts.empty()) return 0;
  std::nth_element(counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2),
                   counts.end());
  const double usual = static_cast<double>(counts[counts.size() / 2]);
  std::size_t low = 0,
              high = std::min(max_points, static_cast<std::size_t>(kAboveUsual * usual) + 1);
  while (low < high) {
    const std::size_t cap = (low + high + 1) / 2;
    std::size_t total = 0;
    for (const auto& [z, points] : layers) total += std::min(points.size(), cap);
    (total <= max_points ? low : high) = total <= max_points ? cap : cap - 1;
  }
  return low;
}

}  // namespace

MatchPoints choose_match_points(std::span<const Eigen::Vector3f> points,
                                const MatchPointsConfig& config) {
  const auto layers = one_per_cube(informative_points(points, config), config);
  const std::size_t cap = layer_cap(layers, static_cast<std::size_t>(config.max_points));
  MatchPoints chosen;
  for (const auto& [z, layer] : layers) {
    const std::size_t kept = std::min(layer.size(), cap);
    for (std::size_t i = 0; i < kept; ++i) {
      const auto& p = layer[i * layer.size() / kept];
      chosen.points.push_back(p);
      chosen.radius_m = std::max(chosen.radius_m, horizontal_range_m(p));
    }
  }
  return chosen;
}

}  // namespace voxlist
