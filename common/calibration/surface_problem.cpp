#include "voxlist/calibration/surface_problem.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/normal_prior.h>

namespace voxlist::calibration {
namespace {

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

struct ContactCost {
  const MirrorBeam beam;
  const double thickness_m;

  template <class T>
  bool operator()(const T* parameters, const T* nearest_point, T* residual) const {
    const Eigen::Map<const Vector3<T>> nearest(nearest_point);
    const T distance = nearest.norm();
    *residual =
        (nearest.dot(point_scanner(beam, parameters)) / distance - distance) / T(thickness_m);
    return true;
  }
};

// Only the turn about the mirror's axis (y) is asked of the level plane: that is what phases do.
struct LevelCost {
  const Eigen::Vector3d across;
  const double sd_rad;

  template <class T>
  bool operator()(const T* nearest_point, T* residual) const {
    const Eigen::Map<const Vector3<T>> nearest(nearest_point);
    *residual = nearest.dot(across.cast<T>()) / nearest.norm() / T(sd_rad);
    return true;
  }
};

std::vector<int> indices_of(const std::array<bool, kParameters>& held) {
  std::vector<int> indices;
  for (int i = 0; i < kParameters; ++i)
    if (held[static_cast<std::size_t>(i)]) indices.push_back(i);
  return indices;
}

}  // namespace

SurfaceProblem::SurfaceProblem(const SurfaceEvidence& evidence, const SurfaceFit& from)
    : parameters_(from.parameters) {
  for (const Plane& plane : from.planes)
    nearest_points_.emplace_back(plane.distance_m * plane.normal);
  add_contacts(evidence);
  if (evidence.level) add_level(*evidence.level);
  add_expected(evidence);
  const std::vector<int> held = indices_of(evidence.held);
  if (held.size() == kParameters)
    problem_.SetParameterBlockConstant(parameters_.data());
  else if (!held.empty())
    problem_.SetManifold(parameters_.data(), new ceres::SubsetManifold(kParameters, held));
}

SurfaceFit SurfaceProblem::fit() const {
  SurfaceFit result{parameters_, {}};
  for (const Eigen::Vector3d& point : nearest_points_)
    result.planes.push_back({point.normalized(), point.norm()});
  return result;
}

std::vector<double*> SurfaceProblem::blocks() {
  std::vector<double*> result{parameters_.data()};
  for (Eigen::Vector3d& point : nearest_points_) result.push_back(point.data());
  return result;
}

// Ceres owns the costs and the loss.
void SurfaceProblem::add_contacts(const SurfaceEvidence& evidence) {
  using Cost = ceres::AutoDiffCostFunction<ContactCost, 1, kParameters, 3>;
  auto* const loss = new ceres::CauchyLoss(kCauchyScale);
  problem_.AddParameterBlock(parameters_.data(), kParameters);
  for (Eigen::Vector3d& point : nearest_points_) problem_.AddParameterBlock(point.data(), 3);
  for (const Contact& contact : evidence.contacts) {
    problem_.AddResidualBlock(
        new Cost(new ContactCost{evidence.beams[contact.beam], evidence.thickness_m}), loss,
        parameters_.data(), nearest_points_[contact.plane].data());
  }
}

void SurfaceProblem::add_level(const LevelPlane& level) {
  const Eigen::Vector3d across = Eigen::Vector3d::UnitY().cross(level.up_scanner).normalized();
  problem_.AddResidualBlock(
      new ceres::AutoDiffCostFunction<LevelCost, 1, 3>(new LevelCost{across, level.sd_rad}),
      nullptr, nearest_points_[level.plane].data());
}

void SurfaceProblem::add_expected(const SurfaceEvidence& evidence) {
  ParameterVector weights;
  for (int i = 0; i < kParameters; ++i)
    weights[i] = 1.0 / kParameterInfos[static_cast<std::size_t>(i)].plausible;
  problem_.AddResidualBlock(
      new ceres::NormalPrior(ceres::Matrix(weights.asDiagonal()), evidence.expected), nullptr,
      parameters_.data());
}

}  // namespace voxlist::calibration
