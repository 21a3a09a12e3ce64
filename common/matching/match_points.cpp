#include "matching/match_points.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "voxels/voxel.h"

namespace voxlist {
namespace {

using Points = std::vector<Eigen::Vector3f>;

double horizontal_range_m(const Eigen::Vector3f& p) { return std::hypot(double(p.x()), double(p.y())); }

bool lexicographic(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

// One point of each cube: the lexicographically first, sorted by cube.
std::map<std::int32_t, Points> one_per_cube(std::span<const Eigen::Vector3f> points, const MatchPointsConfig& config) {
  std::vector<std::pair<Voxel, Eigen::Vector3f>> in_cubes;
  in_cubes.reserve(points.size());
  for (const auto& p : points) {
    if (in_lattice(p, config.spacing_m) && horizontal_range_m(p) <= config.max_range_m) {
      in_cubes.emplace_back(voxel_at(p, config.spacing_m), p);
    }
  }
  std::sort(in_cubes.begin(), in_cubes.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : lexicographic(a.second, b.second);
  });
  std::map<std::int32_t, Points> layers;
  for (std::size_t i = 0; i < in_cubes.size(); ++i) {
    if (i == 0 || in_cubes[i].first != in_cubes[i - 1].first) layers[in_cubes[i].first.z].push_back(in_cubes[i].second);
  }
  return layers;
}

// The largest cap on a layer's points that keeps the total within max_points.
std::size_t layer_cap(const std::map<std::int32_t, Points>& layers, std::size_t max_points) {
  std::size_t low = 0, high = max_points;
  while (low < high) {
    const std::size_t cap = (low + high + 1) / 2;
    std::size_t total = 0;
    for (const auto& [z, points] : layers) total += std::min(points.size(), cap);
    (total <= max_points ? low : high) = total <= max_points ? cap : cap - 1;
  }
  return low;
}

}  // namespace

MatchPoints choose_match_points(std::span<const Eigen::Vector3f> points, const MatchPointsConfig& config) {
  const auto layers = one_per_cube(points, config);
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
