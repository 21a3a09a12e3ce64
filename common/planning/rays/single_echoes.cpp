#include "voxlist/planning/rays/single_echoes.h"

#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace voxlist::planning {
namespace {

// A thing is wide with so many points of one cloud in a square of this edge and the eight round it:
// two lines of three beams.
constexpr double kSquare_m = 0.1;
constexpr int kWidePoints = 6;

// Neighbours are within 2.5 beams of 1 deg of each other (the sine of it). Half a beam falls on
// each thing only where both are this far apart (m): nearer ones blur into a slope.
constexpr float kNeighbour_sine = 0.044F, kApart_m = 0.15F;

using Square = std::int64_t;

Square square_of(const Eigen::Vector3f& p, int dx, int dy) {
  const auto x = static_cast<std::int64_t>(std::floor(p.x() / kSquare_m)) + dx;
  const auto y = static_cast<std::int64_t>(std::floor(p.y() / kSquare_m)) + dy;
  return (x << 32) ^ (y & 0xffffffff);
}

bool are_neighbours(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return a.dot(b) > 0.0F && a.cross(b).norm() < kNeighbour_sine * a.norm() * b.norm();
}

bool is_mixed(const Cloud& cloud, std::size_t i) {
  if (i == 0 || i + 1 >= cloud.points.size()) return false;
  const Eigen::Vector3f ray = cloud.points[i] - cloud.origin(i);
  const Eigen::Vector3f before = cloud.points[i - 1] - cloud.origin(i - 1);
  const Eigen::Vector3f after = cloud.points[i + 1] - cloud.origin(i + 1);
  if (!are_neighbours(ray, before) || !are_neighbours(ray, after)) return false;
  const float range = ray.norm(), a = before.norm() - range, b = after.norm() - range;
  return (a > kApart_m && b < -kApart_m) || (a < -kApart_m && b > kApart_m);
}

}  // namespace

std::vector<Echo> look_at_echoes(const Cloud& cloud) {
  std::unordered_map<Square, int> counts;
  for (const Eigen::Vector3f& p : cloud.points) ++counts[square_of(p, 0, 0)];
  const auto about = [&counts](const Eigen::Vector3f& p) {
    int points = 0;
    for (int i = 0; i < 9; ++i) {
      const auto found = counts.find(square_of(p, i / 3 - 1, i % 3 - 1));
      if (found != counts.end()) points += found->second;
    }
    return points;
  };
  std::vector<Echo> echoes(cloud.points.size());
  for (std::size_t i = 0; i < echoes.size(); ++i)
    echoes[i] = {about(cloud.points[i]) >= kWidePoints, is_mixed(cloud, i)};
  return echoes;
}

}  // namespace voxlist::planning
