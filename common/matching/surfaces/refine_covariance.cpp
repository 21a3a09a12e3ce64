#include "voxlist/matching/surfaces/refine_covariance.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "voxlist/voxels/numbering.h"

namespace voxlist::matching {
namespace {

// Surfels that lie near each other share an error of the map (the lattice, the pose of the scan
// that saw them): about so many have one. Errors in units of the covariance, as the mean of squares
// (bench_tracking 40 1; 3 is exact), on an exact map and on one of misplaced scans: 1.8 and 6.9
// with 1, 1.2 and 4.9 with 7, 0.6 and 2.7 with 30. Less claims too much, more too little.
constexpr double kSharing = 7.0;

// No surfel's mean is surer than this (m): all surfels share half a voxel's rounding and the like,
// which residuals cannot tell. It is half of the 6 mm that one voxel of 0.02 m scatters by. The
// mean of squares (as above) is 1.9 and 7.2 without it, 1.2 and 4.9 with it.
constexpr double kLeastSurfelSigma_m = 0.003;

// The variance of a surfel's normal is so many times what its voxels would give if each erred by
// itself; neighbouring voxels err together. It matters where a corridor's long axis is held by
// chance alone (covariance_test); in rooms the mean of squares changes by 3 % between 0 and 8. A
// judgement.
constexpr double kTiltExcess = 2.0;

// What the points of one surfel say together.
template <int kDof>
struct SurfelSums {
  Square<kDof> information = Square<kDof>::Zero();  // for a point variance of 1
  double weights = 0.0, residuals = 0.0, squares = 0.0;

  double mean() const { return residuals / weights; }
};

// What a normal that is off by chance would seem to hold, for a tilt variance of 1: the directions
// across it (a corridor's long axis), which nothing holds.
template <int kDof>
Square<kDof> held_by_chance(const Correspondence<kDof>& c) {
  Square<kDof> chance = -c.slope * c.slope.transpose();
  for (int axis = 0; axis < kShifts<kDof>; ++axis) {
    const Step<kDof> along = slope<kDof>(Eigen::Vector3d::Unit(axis), c.arm);
    chance += along * along.transpose();
  }
  return chance;
}

template <int kDof>
std::vector<SurfelSums<kDof>> by_surfel(const std::vector<Correspondence<kDof>>& correspondences) {
  Numbering<const Surfel*> numbers;
  std::vector<SurfelSums<kDof>> surfels;
  for (const Correspondence<kDof>& c : correspondences) {
    const auto number = numbers.number(c.surfel);
    if (number == surfels.size()) surfels.emplace_back();
    SurfelSums<kDof>& s = surfels[number];
    s.information += c.weight * (c.slope * c.slope.transpose() -
                                 kTiltExcess * c.surfel->tilt_variance * held_by_chance(c));
    s.weights += c.weight;
    s.residuals += c.weight * c.residual;
    s.squares += c.weight * c.residual * c.residual;
  }
  return surfels;
}

// The variance of points about the mean of their own surfel (m^2).
template <int kDof>
double variance_within(const std::vector<SurfelSums<kDof>>& surfels, double least_sigma_m) {
  double within = 0.0, points = 0.0;
  for (const auto& s : surfels) {
    within += s.squares - s.residuals * s.residuals / s.weights;
    points += s.weights;
  }
  const double freedom = points - static_cast<double>(surfels.size());
  return std::max(freedom > 1.0 ? within / freedom : 0.0, least_sigma_m * least_sigma_m);
}

// The variance of the surfels' means (m^2), without what their points' scatter makes of it.
template <int kDof>
double variance_between(const std::vector<SurfelSums<kDof>>& surfels, double point_variance) {
  double between = 0.0;
  for (const auto& s : surfels) between += s.mean() * s.mean() - point_variance / s.weights;
  return std::max(between / std::max<double>(1.0, static_cast<double>(surfels.size())),
                  kLeastSurfelSigma_m * kLeastSurfelSigma_m);
}

// The covariance of what was known at the start and the information together. In units of the
// start, eigenvalues are how much more the surfaces know; negative ones know nothing.
template <int kDof>
Square<kDof> with_start(const Square<kDof>& information, const Step<kDof>& sigma) {
  const Eigen::SelfAdjointEigenSolver<Square<kDof>> axes(sigma.asDiagonal() * information *
                                                         sigma.asDiagonal());
  const Step<kDof> shrunk = (axes.eigenvalues().cwiseMax(0.0).array() + 1.0).inverse();
  return sigma.asDiagonal() * axes.eigenvectors() * shrunk.asDiagonal() *
         axes.eigenvectors().transpose() * sigma.asDiagonal();
}

}  // namespace

template <int kDof>
Square<kDof> covariance_of(const std::vector<Correspondence<kDof>>& correspondences,
                           const Step<kDof>& start_sigma, double least_sigma_m) {
  const auto surfels = by_surfel(correspondences);
  const double point_variance = variance_within(surfels, least_sigma_m);
  const double surfel_variance = variance_between(surfels, point_variance);
  Square<kDof> information = Square<kDof>::Zero();
  for (const auto& s : surfels)
    information += s.information / (point_variance + kSharing * surfel_variance * s.weights);
  return with_start<kDof>(information, start_sigma);
}

template Square<3> covariance_of(const std::vector<Correspondence<3>>&, const Step<3>&, double);
template Square<6> covariance_of(const std::vector<Correspondence<6>>&, const Step<6>&, double);

}  // namespace voxlist::matching
