#include "services/voxlist/report/measured/scanner_measures.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "voxlist/simulation/random.h"

namespace voxlist::desk {
namespace {

using Eigen::Vector3d;

const Vector3d kMirror(0.0, 0.0, 0.6);  // base

// In the room.
std::vector<Vector3d> in_room(const Cloud& first, const Cloud& second) {
  std::vector<Vector3d> points;
  for (const Cloud& cloud : {first, second})
    for (const Eigen::Vector3f& point : cloud.points)
      points.push_back(kStand * Vector3d(point.cast<double>()));
  return points;
}

// Those that lie near a true plane and clear of the room's edges.
std::vector<Vector3d> on_surface(const std::vector<Vector3d>& points, Eigen::Index axis,
                                 double at_m) {
  constexpr double kNear_m = 0.2, kFromEdge_m = 0.25;
  std::vector<Vector3d> chosen;
  for (const Vector3d& point : points) {
    Vector3d from_edge = kRoomHalf_m - (point - Vector3d(0.0, 0.0, kRoomHalf_m.z())).cwiseAbs();
    from_edge[axis] = kFromEdge_m;
    if (std::abs(point[axis] - at_m) <= kNear_m && from_edge.minCoeff() >= kFromEdge_m)
      chosen.push_back(point);
  }
  return chosen;
}

// The plane that fits points best.
struct Plane {
  Vector3d middle, normal;
  double rms_m;  // distance of the points from it
};

Plane plane_of(const std::vector<Vector3d>& points) {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& point : points) {
    squares += point * point.transpose();
    sum += point;
  }
  const auto count = static_cast<double>(points.size());
  const Vector3d mean = sum / count;
  const Eigen::Matrix3d covariance = squares / count - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  return {mean, solver.eigenvectors().col(0), std::sqrt(std::max(0.0, solver.eigenvalues()[0]))};
}

double flatness_m(const std::vector<Vector3d>& points, Eigen::Index axis, double at_m) {
  return plane_of(on_surface(points, axis, at_m)).rms_m;
}

}  // namespace

RandomError random_error(const Cloud& first, const Cloud& second) {
  const auto points = in_room(first, second);
  const Vector3d& half = kRoomHalf_m;
  return {flatness_m(points, 2, 2.0 * half.z()),
          (flatness_m(points, 0, -half.x()) + flatness_m(points, 0, half.x())) / 2.0,
          (flatness_m(points, 1, -half.y()) + flatness_m(points, 1, half.y())) / 2.0};
}

std::vector<ErrorAtDistance> error_by_distance(const Cloud& first, const Cloud& second) {
  constexpr int kMetres = 9, kEnough = 100;
  const Vector3d mirror = kStand * kMirror;
  const auto points = in_room(first, second);
  const Vector3d& half = kRoomHalf_m;
  std::array<ErrorAtDistance, kMetres> bins{};
  const auto add = [&](Eigen::Index axis, double at_m) {
    const std::vector<Vector3d> surface = on_surface(points, axis, at_m);
    const Plane plane = plane_of(surface);
    for (const Vector3d& point : surface) {
      ErrorAtDistance& bin =
          bins[static_cast<std::size_t>(std::min((point - mirror).norm(), kMetres - 1.0))];
      const double off_m = (point - plane.middle).dot(plane.normal);
      bin.rms_m += off_m * off_m;
      ++bin.points;
    }
  };
  add(2, 2.0 * half.z());
  for (const double side : {-1.0, 1.0}) {
    add(0, side * half.x());
    add(1, side * half.y());
  }
  std::vector<ErrorAtDistance> told;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    if (bins[i].points < kEnough) continue;
    const auto from_m = static_cast<double>(i);
    told.push_back(
        {from_m, from_m + 1.0, std::sqrt(bins[i].rms_m / bins[i].points), bins[i].points});
  }
  return told;
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
  double sum = 0.0;
  for (const auto& point : points)
    sum += (point.seen - point.truth).norm() * 6.0 / (point.truth - kMirror).norm();
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
