#include "voxlist/calibration/planes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

namespace voxlist::calibration {
namespace {

using Eigen::Vector3d;

constexpr double kCell_m = 0.15;        // one point for each such cube: counts are areas
constexpr double kReach_m = 0.45;       // a point's normal is that of its neighbours so near
constexpr std::size_t kNeighbours = 6;  // at least
constexpr double kFlat = 0.2;           // thickness of a flat neighbourhood over its width
constexpr double kSameNormal = 0.9;     // cosine of 26 deg
constexpr std::size_t kSeeds = 400;     // planes tried for each one that is found
constexpr double kMinArea_m2 = 1.2;
constexpr double kMinWidth_m = 0.2;     // standard deviation along its narrower side
constexpr double kMinDistance_m = 0.3;  // from the origin: nearer ones are seen edge-on
constexpr std::size_t kMaxPlanes = 16;

struct OrientedPoint {
  Vector3d point, normal;
};

// Directions of the least, middle and greatest spread, and the spreads (standard deviations).
struct Spread {
  Vector3d mean;
  Eigen::Matrix3d directions;
  Vector3d sd_m;
};

class Moments {
 public:
  void add(const Vector3d& p) {
    ++count_;
    sum_ += p;
    squares_ += p * p.transpose();
  }

  std::size_t count() const { return count_; }

  Spread spread() const {
    const double n = static_cast<double>(count_);
    const Vector3d mean = sum_ / n;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squares_ / n -
                                                                mean * mean.transpose());
    return {mean, solver.eigenvectors(), solver.eigenvalues().cwiseMax(0.0).cwiseSqrt()};
  }

 private:
  std::size_t count_ = 0;
  Vector3d sum_ = Vector3d::Zero();
  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();
};

using Cell = std::tuple<int, int, int>;

Cell cell_of(const Vector3d& point, double size_m) {
  const auto index = [size_m](double x) { return static_cast<int>(std::floor(x / size_m)); };
  return {index(point.x()), index(point.y()), index(point.z())};
}

std::vector<Vector3d> one_per_cell(std::span<const Vector3d> points) {
  std::map<Cell, Vector3d> first;
  for (const Vector3d& point : points) first.emplace(cell_of(point, kCell_m), point);
  std::vector<Vector3d> result;
  for (const auto& [cell, point] : first) result.push_back(point);
  return result;
}

// Points whose neighbourhood is flat, with its normal.
std::vector<OrientedPoint> orient(const std::vector<Vector3d>& points) {
  std::map<Cell, std::vector<Vector3d>> cells;
  for (const Vector3d& point : points) cells[cell_of(point, kReach_m)].push_back(point);
  const auto neighbourhood = [&](const Vector3d& at) {
    Moments moments;
    const auto [x, y, z] = cell_of(at, kReach_m);
    for (int i = 0; i < 27; ++i) {
      const auto found = cells.find({x + i / 9 - 1, y + i / 3 % 3 - 1, z + i % 3 - 1});
      if (found == cells.end()) continue;
      for (const Vector3d& point : found->second)
        if ((point - at).norm() < kReach_m) moments.add(point);
    }
    return moments;
  };
  std::vector<OrientedPoint> result;
  for (const Vector3d& point : points) {
    const Moments moments = neighbourhood(point);
    if (moments.count() < kNeighbours) continue;
    const Spread spread = moments.spread();
    if (spread.sd_m[0] < kFlat * spread.sd_m[2] && spread.sd_m[0] < 0.5 * spread.sd_m[1])
      result.push_back({point, spread.directions.col(0)});
  }
  return result;
}

Plane outward(const Vector3d& normal, const Vector3d& through) {
  const double distance = normal.dot(through);
  return distance < 0.0 ? Plane{-normal, -distance} : Plane{normal, distance};
}

bool lies_in(const OrientedPoint& p, const Plane& plane, double tolerance_m) {
  return std::abs(plane.distance_to(p.point)) < tolerance_m &&
         std::abs(plane.normal.dot(p.normal)) > kSameNormal;
}

std::size_t count_in(const std::vector<OrientedPoint>& points, const Plane& plane,
                     double tolerance_m) {
  const auto in = [&](const OrientedPoint& p) { return lies_in(p, plane, tolerance_m); };
  return static_cast<std::size_t>(std::ranges::count_if(points, in));
}

// The plane through the most points, among those that a point with its normal spans.
Plane best_plane(const std::vector<OrientedPoint>& points, double tolerance_m) {
  Plane best;
  std::size_t most = 0;
  const std::size_t stride = points.size() / kSeeds + 1;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const Plane plane = outward(points[i].normal, points[i].point);
    const std::size_t count = count_in(points, plane, tolerance_m);
    if (count <= most) continue;
    most = count;
    best = plane;
  }
  return best;
}

Spread spread_in(const std::vector<OrientedPoint>& points, const Plane& plane, double tolerance_m) {
  Moments moments;
  for (const OrientedPoint& p : points)
    if (lies_in(p, plane, tolerance_m)) moments.add(p.point);
  return moments.spread();
}

}  // namespace

std::vector<Plane> find_planes(std::span<const Vector3d> points, double tolerance_m) {
  constexpr int kFits = 3;
  const auto min_count = static_cast<std::size_t>(kMinArea_m2 / (kCell_m * kCell_m));
  std::vector<OrientedPoint> left = orient(one_per_cell(points));
  std::vector<Plane> planes;
  for (std::size_t i = 0; i < kMaxPlanes && left.size() > min_count; ++i) {
    Plane plane = best_plane(left, tolerance_m);
    if (count_in(left, plane, tolerance_m) < min_count) break;
    for (int fit = 0; fit < kFits && count_in(left, plane, tolerance_m) > 2; ++fit) {
      const Spread spread = spread_in(left, plane, tolerance_m);
      plane = outward(spread.directions.col(0), spread.mean);
    }
    const bool wide = count_in(left, plane, tolerance_m) >= min_count &&
                      spread_in(left, plane, tolerance_m).sd_m[1] > kMinWidth_m;
    if (wide && plane.distance_m > kMinDistance_m) planes.push_back(plane);
    std::erase_if(left, [&](const OrientedPoint& p) { return lies_in(p, plane, tolerance_m); });
  }
  return planes;
}

std::vector<std::optional<std::size_t>> associate(std::span<const Vector3d> points,
                                                  const std::vector<Plane>& planes,
                                                  double tolerance_m) {
  std::vector<std::optional<std::size_t>> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::size_t near = 0;
    for (std::size_t k = 0; k < planes.size(); ++k) {
      if (std::abs(planes[k].distance_to(points[i])) > tolerance_m) continue;
      ++near;
      result[i] = k;
    }
    if (near != 1) result[i].reset();
  }
  return result;
}

}  // namespace voxlist::calibration
