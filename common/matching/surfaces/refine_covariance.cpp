#include "voxlist/matching/surfaces/refine_covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "voxlist/voxels/fast_cell.h"
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
  Step<kDof> pull = Step<kDof>::Zero();
  double weights = 0.0, residuals = 0.0, squares = 0.0;
  const Surfel* surfel = nullptr;

  double mean() const { return residuals / weights; }
};

// What a normal that is off by chance would seem to hold, for a tilt variance of 1: the directions
// across it (a corridor's long axis), which nothing holds: all shifts of the point, less the one
// along the normal. Column by column.
template <int kDof>
class HeldByChance {
 public:
  explicit HeldByChance(const Correspondence<kDof>& c) : slope_(c.slope) {
    for (int axis = 0; axis < kShifts<kDof>; ++axis)
      shifts_[axis] = slope<kDof>(Eigen::Vector3d::Unit(axis), c.arm);
  }

  auto column(int j) const {
    const auto across =
        -slope_ * slope_[j] + shifts_[0] * shifts_[0][j] + shifts_[1] * shifts_[1][j];
    if constexpr (kDof == 3)
      return across;
    else
      return across + shifts_[2] * shifts_[2][j];
  }

 private:
  const Step<kDof>& slope_;
  Step<kDof> shifts_[kShifts<kDof>];
};

template <int kDof>
std::vector<SurfelSums<kDof>> by_surfel(const std::vector<Correspondence<kDof>>& correspondences) {
  Numbering<const Surfel*> numbers;
  std::vector<SurfelSums<kDof>> surfels;
  for (const Correspondence<kDof>& c : correspondences) {
    const auto number = numbers.number(c.surfel);
    if (number == surfels.size()) surfels.emplace_back();
    SurfelSums<kDof>& s = surfels[number];
    const HeldByChance<kDof> chance(c);
    const double excess = kTiltExcess * c.surfel->tilt_variance;
    const auto told = [&](int j) {
      return c.weight * (c.slope * c.slope[j] - excess * chance.column(j));
    };
    add_lower<kDof>(told, s.information);
    s.surfel = c.surfel;
    s.pull += c.weight * c.residual * c.slope;
    s.weights += c.weight;
    s.residuals += c.weight * c.residual;
    s.squares += c.weight * c.residual * c.residual;
  }
  for (SurfelSums<kDof>& s : surfels) s.information = mirrored<kDof>(s.information);
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

// The covariance of what was known before and the information together. In units of what was
// known, eigenvalues are how much more the surfaces know; negative ones know nothing.
template <int kDof>
Square<kDof> with(const Square<kDof>& before, const Square<kDof>& information) {
  const Square<kDof> root = before.llt().matrixL();
  const Eigen::SelfAdjointEigenSolver<Square<kDof>> axes(root.transpose() * information * root);
  const Step<kDof> shrunk = (axes.eigenvalues().cwiseMax(0.0).array() + 1.0).inverse();
  return root * axes.eigenvectors() * shrunk.asDiagonal() * axes.eigenvectors().transpose() *
         root.transpose();
}

// What the surfaces of one place (m) pull a pose by, they may pull it by together: a wall that is
// seen at an angle, a scan that was tilted, a car that is no plane. A judgement: the size of a car.
constexpr double kPlace_m = 2.5;

// The information as far as the places agree: where they pull a pose to and fro by more than their
// points' scatter explains, its variance is larger by that (the sandwich estimate of a variance, of
// White and of Huber, in clusters).
template <int kDof>
Square<kDof> believed(const Square<kDof>& information, const std::vector<Step<kDof>>& pulls,
                      const Square<kDof>& before) {
  // In units in which the information is one, as far as there is any beside what was known before.
  const Square<kDof> known = before.inverse();
  const Eigen::LLT<Square<kDof>> root(information + known);
  if (root.info() != Eigen::Success) return information;
  Square<kDof> scatter = Square<kDof>::Zero();
  for (const Step<kDof>& pull : pulls) {
    const Step<kDof> scaled = root.matrixL().solve(pull);
    scatter += scaled * scaled.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Square<kDof>> axes(scatter);
  const Step<kDof> excess = axes.eigenvalues().cwiseMax(1.0);
  const Square<kDof> turn = axes.eigenvectors(), l = root.matrixL();
  const Square<kDof> shrunk = turn * excess.cwiseInverse().asDiagonal() * turn.transpose();
  const Square<kDof> own = root.matrixL().solve(root.matrixL().solve(information).transpose());
  // own: the information in these units, at most one; believed to the share that the excess leaves.
  const Eigen::SelfAdjointEigenSolver<Square<kDof>> half(shrunk);
  const Square<kDof> half_shrunk = half.operatorSqrt();
  return l * half_shrunk * own * half_shrunk * l.transpose();
}

// What few surfels of few voxels alone tell of the horizontal direction that all hold least, those
// that tell most: they may be no surfaces, such as one ring of a laser across a corner, and nothing
// contradicts them. So many of a hundred surfels, and one: in a corridor seen by 49 rings some 15
// of 344 held its long axis.
constexpr std::size_t kFewOfHundred = 5;

template <int kDof>
Square<kDof> of_few_surfels(const Square<kDof>& information, std::vector<Square<kDof>> told,
                            std::size_t surfels) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(
      Eigen::Matrix2d(information.template topLeftCorner<2, 2>()));
  Step<kDof> least = Step<kDof>::Zero();
  least.template head<2>() = axes.eigenvectors().col(0);
  const auto tells = [&](const Square<kDof>& s) { return least.dot(s * least); };
  const std::size_t few = std::min(told.size(), 1 + kFewOfHundred * surfels / 100);
  std::partial_sort(told.begin(), told.begin() + static_cast<std::ptrdiff_t>(few), told.end(),
                    [&](const auto& a, const auto& b) { return tells(a) > tells(b); });
  Square<kDof> sum = Square<kDof>::Zero();
  for (std::size_t i = 0; i < few; ++i) sum += told[i];
  return sum;
}

}  // namespace

template <int kDof>
Square<kDof> covariance_of(const std::vector<Correspondence<kDof>>& correspondences,
                           const Square<kDof>& before, double least_sigma_m, bool doubted,
                           bool lines_hold) {
  const auto surfels = by_surfel(correspondences);
  const double point_variance = variance_within(surfels, least_sigma_m);
  const double surfel_variance = variance_between(surfels, point_variance);
  Square<kDof> information = Square<kDof>::Zero();
  Numbering<Voxel> places;
  std::vector<Step<kDof>> pulls;
  std::vector<Square<kDof>> told;
  for (const auto& s : surfels) {
    if (!lines_hold && s.surfel->of_line) continue;
    const double variance = point_variance + kSharing * surfel_variance * s.weights;
    information += s.information / variance;
    if (s.surfel->of_few_voxels) told.push_back(s.information / variance);
    const auto place = places.number(cell_at(s.surfel->mean, 1.0 / kPlace_m));
    if (place == pulls.size()) pulls.push_back(Step<kDof>::Zero());
    pulls[place] += s.pull / variance;
  }
  if (doubted) {
    information -= of_few_surfels(information, told, surfels.size());
    information = believed<kDof>(information, pulls, before);
  }
  return with<kDof>(before, information);
}

template Square<3> covariance_of(const std::vector<Correspondence<3>>&, const Square<3>&, double,
                                 bool, bool);
template Square<6> covariance_of(const std::vector<Correspondence<6>>&, const Square<6>&, double,
                                 bool, bool);

}  // namespace voxlist::matching
