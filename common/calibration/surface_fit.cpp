#include "voxlist/calibration/surface_fit.h"

#include <ceres/crs_matrix.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <map>

#include "voxlist/calibration/patches.h"
#include "voxlist/calibration/surface_problem.h"

namespace voxlist::calibration {
namespace {

Eigen::VectorXd row_of(const ceres::CRSMatrix& matrix, std::size_t row) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(matrix.num_cols);
  for (int i = matrix.rows[row]; i < matrix.rows[row + 1]; ++i)
    result[matrix.cols[static_cast<std::size_t>(i)]] = matrix.values[static_cast<std::size_t>(i)];
  return result;
}

// The sandwich: curvature of the robust cost, and how the gradient's parts scatter.
class RobustCovariance {
 public:
  explicit RobustCovariance(int size)
      : curvature_(Eigen::MatrixXd::Zero(size, size)), scatter_(curvature_) {}

  // Derivatives of Cauchy's loss c^2 / 2 log(1 + u^2 / c^2).
  void add_contact(const Eigen::VectorXd& jacobian, double residual, const Patch& patch) {
    const double over = residual * residual / (kCauchyScale * kCauchyScale);
    const double weight = 1.0 / (1.0 + over);
    curvature_.noalias() += (1.0 - over) * weight * weight * jacobian * jacobian.transpose();
    auto [at, is_new] = gradients_.try_emplace(patch, Eigen::VectorXd::Zero(jacobian.size()));
    at->second += weight * residual * jacobian;
  }

  void add_known(const Eigen::VectorXd& jacobian) {
    curvature_.noalias() += jacobian * jacobian.transpose();
    scatter_.noalias() += jacobian * jacobian.transpose();
  }

  Eigen::MatrixXd matrix() const {
    Eigen::MatrixXd scatter = scatter_;
    for (const auto& [patch, gradient] : gradients_)
      scatter.noalias() += gradient * gradient.transpose();
    const Eigen::LDLT<Eigen::MatrixXd> solver(curvature_);
    return solver.solve(solver.solve(scatter).transpose());
  }

 private:
  Eigen::MatrixXd curvature_, scatter_;
  std::map<Patch, Eigen::VectorXd> gradients_;
};

}  // namespace

SurfaceFit make_thin(const SurfaceEvidence& evidence, const SurfaceFit& from) {
  SurfaceProblem surfaces(evidence, from);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = 10;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &surfaces.problem(), &summary);
  return surfaces.fit();
}

ParameterVector standard_deviations(const SurfaceEvidence& evidence, const SurfaceFit& fit) {
  SurfaceProblem surfaces(evidence, fit);
  ceres::Problem::EvaluateOptions options;
  options.apply_loss_function = false;
  options.parameter_blocks = surfaces.blocks();
  std::vector<double> residuals;
  ceres::CRSMatrix jacobian;
  surfaces.problem().Evaluate(options, nullptr, &residuals, nullptr, &jacobian);

  RobustCovariance covariance(jacobian.num_cols);
  for (std::size_t row = 0; row < residuals.size(); ++row) {
    if (row >= evidence.contacts.size()) {
      covariance.add_known(row_of(jacobian, row));
      continue;
    }
    const Patch patch = patch_of(evidence, fit, evidence.contacts[row]);
    covariance.add_contact(row_of(jacobian, row), residuals[row], patch);
  }
  const Eigen::MatrixXd matrix = covariance.matrix();
  ParameterVector result = ParameterVector::Zero();
  int column = 0;
  for (int i = 0; i < kParameters; ++i) {
    if (evidence.held[static_cast<std::size_t>(i)]) continue;
    result[i] = std::sqrt(std::max(0.0, matrix(column, column)));
    ++column;
  }
  return result;
}

std::vector<double> distances(const SurfaceEvidence& evidence, const SurfaceFit& fit) {
  std::vector<double> result;
  for (const Contact& contact : evidence.contacts) {
    const Eigen::Vector3d point =
        point_scanner(evidence.beams[contact.beam], fit.parameters.data());
    result.push_back(fit.planes[contact.plane].distance_to(point));
  }
  return result;
}

}  // namespace voxlist::calibration
