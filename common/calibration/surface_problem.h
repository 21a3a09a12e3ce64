#pragma once

#include <ceres/problem.h>

#include "voxlist/calibration/surface_fit.h"

namespace voxlist::calibration {

/// Scale of Cauchy's robust loss, in standard deviations: residuals far beyond it no longer pull.
/// The usual 2.385 keeps 95 % of the precision when the noise is Gaussian.
inline constexpr double kCauchyScale = 2.4;

/// A fit as Ceres sees it: the parameters, and each plane by its point nearest to the origin. First
/// the contacts' residuals in their order, in units of the thickness, then what is known beside.
class SurfaceProblem {
 public:
  SurfaceProblem(const SurfaceEvidence& evidence, const SurfaceFit& from);

  ceres::Problem& problem() { return problem_; }
  SurfaceFit fit() const;

  /// Blocks in the order of the Jacobian's columns: parameters, then planes.
  std::vector<double*> blocks();

 private:
  void add_contacts(const SurfaceEvidence& evidence);
  void add_level(const LevelPlane& level);
  void add_expected(const SurfaceEvidence& evidence);

  ParameterVector parameters_;
  std::vector<Eigen::Vector3d> nearest_points_;
  ceres::Problem problem_;
};

}  // namespace voxlist::calibration
