#include "voxlist/matching/surfaces/refine.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdint>

#include "voxlist/voxels/numbering.h"

namespace voxlist::matching {
namespace {

// Neighbouring surfels share errors of the map (the lattice, the poses of its scans): about so many
// have one. And the residuals cannot tell what all surfels share, such as half a voxel's rounding.
constexpr double kSharing = 7.0, kLeastSurfelSigma_m = 0.003;
// Normals scatter more than independent voxels would.
constexpr double kTiltExcess = 2.0;

// A step of a pose: what can be moved, as a part of (x, y, z, roll, pitch, yaw) about map's axes.
template <int kDof>
using Step = Eigen::Matrix<double, kDof, 1>;
template <int kDof>
using Square = Eigen::Matrix<double, kDof, kDof>;

// How a point's distance from a plane with normal n changes; `arm` is from base to the point.
template <int kDof>
Step<kDof> slope(const Eigen::Vector3d& n, const Eigen::Vector3d& arm) {
  if constexpr (kDof == 3)
    return {n.x(), n.y(), arm.x() * n.y() - arm.y() * n.x()};
  else
    return (Step<6>() << n, arm.cross(n)).finished();
}

template <int kDof>
constexpr int kShifts = kDof == 3 ? 2 : 3;  // of a step's coordinates; the others are turns

void move(const Step<3>& step, Pose3& pose) {
  pose.translation().head<2>() += step.head<2>();
  pose.linear() = Eigen::AngleAxisd(step.z(), Eigen::Vector3d::UnitZ()) * pose.linear();
}

void move(const Step<6>& step, Pose3& pose) {
  const Eigen::Vector3d turn = step.tail<3>();
  const double angle = turn.norm();
  pose.translation() += step.head<3>();
  if (angle > 0.0) pose.linear() = Eigen::AngleAxisd(angle, turn / angle) * pose.linear();
}

// A point that lies on or near a surfel that its ray could see.
template <int kDof>
struct Held {
  const Surfel* surfel;
  Eigen::Vector3d arm;
  Step<kDof> slope;
  double residual, weight;
};

template <int kDof>
std::vector<Held<kDof>> held_points(const SurfelMap& surfels, const RayPoints& scan,
                                    const Pose3& pose, double scale_m,
                                    std::vector<SurfelMap::Place>& places) {
  std::vector<Held<kDof>> held;
  held.reserve(scan.points.size());
  const Eigen::Matrix3d turn = pose.linear();
  const Eigen::Vector3d base = pose.translation();
  const double scale2 = scale_m * scale_m;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3d arm = turn * scan.points[i].cast<double>(), p = base + arm;
    const Eigen::Vector3d origin =
        scan.origins.empty() ? base : (base + turn * scan.origins[i].cast<double>()).eval();
    const Surfel* surfel = surfels.find(p, origin, places[i]);
    if (!surfel) continue;
    const double residual = surfel->normal.dot(p - surfel->mean);
    const double falloff = scale2 / (scale2 + residual * residual);
    held.push_back({surfel, arm, slope<kDof>(surfel->normal, arm), residual, falloff * falloff});
  }
  return held;
}

// How well the points lie on the surfaces.
template <int kDof, class Result>
void tell_fit(const std::vector<Held<kDof>>& held, std::size_t points, double scale_m,
              Result& result) {
  double squares = 0.0;
  int inliers = 0;
  for (const Held<kDof>& h : held) {
    if (std::abs(h.residual) >= 2.0 * scale_m) continue;
    squares += h.residual * h.residual;
    ++inliers;
  }
  if (points > 0) result.inlier_share = inliers / static_cast<double>(points);
  if (inliers > 0) result.residual_m = std::sqrt(squares / inliers);
}

// One deviation for all shifts, and one for all turns.
template <int kDof>
Step<kDof> deviations(double shift_m, double turn_rad) {
  Step<kDof> all = Step<kDof>::Constant(turn_rad);
  all.template head<kShifts<kDof>>().setConstant(shift_m);
  return all;
}

// A step that is worth a metre of each coordinate: the start's own uncertainty.
template <int kDof>
Step<kDof> start_deviations(const RefineConfig& config) {
  return deviations<kDof>(config.start_sigma_m, config.start_sigma_rad);
}

// What the points of one surfel say together.
template <int kDof>
struct OfSurfel {
  Square<kDof> information = Square<kDof>::Zero();  // of all its points, in units of 1 / variance
  double weights = 0.0, residuals = 0.0, squares = 0.0;
};

template <int kDof>
std::vector<OfSurfel<kDof>> by_surfel(const std::vector<Held<kDof>>& held) {
  Numbering<const Surfel*> numbers;
  std::vector<OfSurfel<kDof>> surfels;
  for (const Held<kDof>& h : held) {
    const auto number = numbers.number(h.surfel);
    if (number == surfels.size()) surfels.emplace_back();
    OfSurfel<kDof>& s = surfels[number];
    // A normal that is off by chance seems to hold directions that nothing holds (a corridor's long
    // axis): what chance alone would hold is taken off.
    Square<kDof> chance = -h.slope * h.slope.transpose();
    for (int axis = 0; axis < kShifts<kDof>; ++axis) {
      const Step<kDof> along = slope<kDof>(Eigen::Vector3d::Unit(axis), h.arm);
      chance += along * along.transpose();
    }
    s.information +=
        h.weight * (h.slope * h.slope.transpose() - kTiltExcess * h.surfel->tilt_variance * chance);
    s.weights += h.weight;
    s.residuals += h.weight * h.residual;
    s.squares += h.weight * h.residual * h.residual;
  }
  return surfels;
}

// How well the map's surfaces hold the pose, as if they stood right where the map has them. Points
// of one surfel share its error, so many of them tell little more than a few: each surfel counts
// with the variance of its mean, both parts of which are read off the residuals.
template <int kDof>
Square<kDof> covariance_of(const std::vector<Held<kDof>>& held, const RefineConfig& config) {
  const auto surfels = by_surfel(held);
  double within = 0.0, points = 0.0, between = 0.0;
  for (const auto& s : surfels) {
    within += s.squares - s.residuals * s.residuals / s.weights;
    points += s.weights;
  }
  const double freedom = points - static_cast<double>(surfels.size());
  const double point_variance =
      std::max(freedom > 1.0 ? within / freedom : 0.0, config.least_sigma_m * config.least_sigma_m);
  for (const auto& s : surfels) {
    const double mean = s.residuals / s.weights;
    between += mean * mean - point_variance / s.weights;
  }
  const double surfel_variance =
      std::max(between / std::max<double>(1.0, static_cast<double>(surfels.size())),
               kLeastSurfelSigma_m * kLeastSurfelSigma_m);
  const Step<kDof> start = start_deviations<kDof>(config);
  Square<kDof> information = Square<kDof>::Zero();
  for (const auto& s : surfels) {
    const double variance = point_variance + kSharing * surfel_variance * s.weights;
    information += s.information / variance;
  }
  // In units of the start: eigenvalues are then how much more the surfaces know.
  const Eigen::SelfAdjointEigenSolver<Square<kDof>> axes(start.asDiagonal() * information *
                                                         start.asDiagonal());
  const Step<kDof> shrunk = (axes.eigenvalues().cwiseMax(0.0).array() + 1.0).inverse();
  return start.asDiagonal() * axes.eigenvectors() * shrunk.asDiagonal() *
         axes.eigenvectors().transpose() * start.asDiagonal();
}

template <int kDof, class Result>
Pose3 refine_pose(const SurfelMap& surfels, const RayPoints& scan, const Pose3& start,
                  const RefineConfig& config, Result& result) {
  constexpr int kShift = kShifts<kDof>, kTurn = kDof - kShift;
  Pose3 pose = start;
  const Step<kDof> start_information = start_deviations<kDof>(config).array().square().inverse();
  // A step's size in metres: turning counts at a few metres' range.
  Step<kDof> lever_m, moved = Step<kDof>::Zero();
  lever_m.template head<kShift>().setConstant(1.0);
  lever_m.template tail<kTurn>().setConstant(5.0);
  std::vector<Held<kDof>> held;
  std::vector<SurfelMap::Place> places(scan.points.size());
  for (int i = 0; i < config.max_iterations && !result.converged; ++i) {
    held = held_points<kDof>(surfels, scan, pose, config.scale_m, places);
    Square<kDof> information = Square<kDof>::Zero();
    Step<kDof> gradient = Step<kDof>::Zero();
    double squares = 0.0, weights = 0.0;
    for (const Held<kDof>& h : held) {
      information += h.weight * h.slope * h.slope.transpose();
      gradient += h.weight * h.residual * h.slope;
      squares += h.weight * h.residual * h.residual;
      weights += h.weight;
    }
    const double variance =
        std::max(squares / std::max(weights, 1.0), config.least_sigma_m * config.least_sigma_m);
    information /= variance;
    information.diagonal() += start_information;
    const Step<kDof> step =
        information.ldlt().solve(-(gradient / variance + start_information.cwiseProduct(moved)));
    move(step, pose);
    moved += step;
    result.converged = step.cwiseProduct(lever_m).norm() < config.converged_m;
  }
  result.covariance = covariance_of(held, config);
  // Normals that are off by chance drag the pose along what nothing holds, each point a little: as
  // far as the start knows better, the way is taken back. Turns stay: any wall holds them, and far
  // better than a lattice does.
  Step<kDof> back = -result.covariance * start_information.cwiseProduct(moved);
  back.template tail<kTurn>().setZero();
  move(back, pose);
  const auto of_map = deviations<kDof>(config.map_sigma_m, config.map_sigma_rad);
  result.covariance.diagonal() += of_map.cwiseAbs2();
  tell_fit(held, scan.points.size(), config.scale_m, result);
  return pose;
}

}  // namespace

Refinement refine(const SurfelMap& surfels, const RayPoints& scan, const Pose2& start,
                  const RefineConfig& config) {
  Refinement result;
  const Pose3 pose = refine_pose<3>(surfels, scan, to_pose3(start), config, result);
  result.pose = to_pose2(pose);
  return result;
}

SpatialRefinement refine(const SurfelMap& surfels, const RayPoints& scan, const Pose3& start,
                         const RefineConfig& config) {
  SpatialRefinement result;
  result.pose = refine_pose<6>(surfels, scan, start, config, result);
  return result;
}

}  // namespace voxlist::matching
