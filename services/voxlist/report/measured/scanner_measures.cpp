#include "services/voxlist/report/measured/scanner_measures.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "voxlist/simulation/random.h"

namespace voxlist::desk {
namespace {

using Eigen::Vector3d;

// In the room.
std::vector<Vector3d> in_room(const Cloud& first, const Cloud& second) {
  std::vector<Vector3d> points;
  for (const Cloud& cloud : {first, second})
    for (const Eigen::Vector3f& point : cloud.points)
      points.push_back(kStand * Vector3d(point.cast<double>()));
  return points;
}

// RMS distance from their own plane of the points that lie near a true one and clear of the room's
// edges.
double flatness_m(const std::vector<Vector3d>& points, Eigen::Index axis, double at_m) {
  constexpr double kNear_m = 0.2, kFromEdge_m = 0.25;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Vector3d sum = Vector3d::Zero();
  double count = 0.0;
  for (const Vector3d& point : points) {
    Vector3d from_edge = kRoomHalf_m - (point - Vector3d(0.0, 0.0, kRoomHalf_m.z())).cwiseAbs();
    from_edge[axis] = kFromEdge_m;
    if (std::abs(point[axis] - at_m) > kNear_m || from_edge.minCoeff() < kFromEdge_m) continue;
    squares += point * point.transpose();
    sum += point;
    count += 1.0;
  }
  const Vector3d mean = sum / count;
  const Eigen::Matrix3d covariance = squares / count - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
}

}  // namespace

RandomError random_error(const Cloud& first, const Cloud& second) {
  const auto points = in_room(first, second);
  const Vector3d& half = kRoomHalf_m;
  return {flatness_m(points, 2, 2.0 * half.z()),
          (flatness_m(points, 0, -half.x()) + flatness_m(points, 0, half.x())) / 2.0,
          (flatness_m(points, 1, -half.y()) + flatness_m(points, 1, half.y())) / 2.0};
}

double error_on_six_metres(const std::vector<ScannerRecording::SeenPoint>& points) {
  constexpr int kPairs = 5000, kTries = 1'000'000;
  simulation::Random random(6);
  const auto any = [&]() -> const ScannerRecording::SeenPoint& {
    return points[random.bits() % points.size()];
  };
  double sum = 0.0;
  int pairs = 0;
  for (int i = 0; i < kTries && pairs < kPairs; ++i) {
    const ScannerRecording::SeenPoint &a = any(), &b = any();
    const double truth_m = (a.truth - b.truth).norm();
    if (truth_m < 5.5 || truth_m > 6.5) continue;
    sum += std::abs((a.seen - b.seen).norm() - truth_m);
    ++pairs;
  }
  return sum / pairs;
}

double error_at_six_metres(const std::vector<ScannerRecording::SeenPoint>& points) {
  const Vector3d mirror(0.0, 0.0, 0.6);
  double sum = 0.0;
  for (const auto& point : points)
    sum += (point.seen - point.truth).norm() * 6.0 / (point.truth - mirror).norm();
  return sum / static_cast<double>(points.size());
}

std::vector<double> closest_distances(const Cloud& first, const Cloud& second) {
  std::vector<double> distances_m;
  for (const Eigen::Vector3f& point : first.points) {
    float nearest = std::numeric_limits<float>::infinity();
    for (const Eigen::Vector3f& other : second.points)
      nearest = std::min(nearest, (point - other).squaredNorm());
    distances_m.push_back(std::sqrt(static_cast<double>(nearest)));
  }
  std::ranges::sort(distances_m);
  return distances_m;
}

std::array<double, 40> by_millimetre(const std::vector<double>& distances_m) {
  std::array<double, 40> shares{};
  for (const double distance_m : distances_m) {
    const auto bin = static_cast<std::size_t>(distance_m * 1e3);
    if (bin < shares.size()) shares[bin] += 1.0 / static_cast<double>(distances_m.size());
  }
  return shares;
}

}  // namespace voxlist::desk
