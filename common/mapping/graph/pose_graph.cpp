#include "voxlist/mapping/graph/pose_graph.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>

#include "voxlist/geometry/elementary.h"
#include "voxlist/system/check.h"

namespace voxlist::mapping {
namespace {

// An edge's distance (squared) at which kernels begin to let go: 1 of 40 right ones is farther off
// (three degrees of freedom).
constexpr double kScale2 = 9.0;
// A solve of right edges takes 4 to 6 steps, with kernels up to 30; more bring nothing.
constexpr int kMostSteps = 50;
// It ends when no coordinate moves by more than this (m, rad): a thousandth of what poses are
// rounded to.
constexpr double kConverged = 1e-7;
// What holds a pose that no edge holds, once each step: 1 km, as a standard deviation.
constexpr double kHold = 1e-6;

using Triplets = std::vector<Eigen::Triplet<double>>;

// The normal equations of all poses but the first.
struct Normal {
  Eigen::SparseMatrix<double> information;
  Eigen::VectorXd gradient;
};

// How an edge's miss changes with the pose that it comes from, and with the one that it goes to.
struct Slopes {
  Eigen::Matrix3d from = Eigen::Matrix3d::Identity(), to = Eigen::Matrix3d::Identity();
};

Slopes slopes_of(const Pose2& from, const Pose2& to) {
  const auto [sine, cosine] = elementary::sine_cosine(from.yaw_rad);
  const Pose2 seen = from.inverse() * to;
  Slopes slopes;
  slopes.to.topLeftCorner<2, 2>() << cosine, sine, -sine, cosine;
  slopes.from = -slopes.to;
  slopes.from(0, 2) = seen.y_m;
  slopes.from(1, 2) = -seen.x_m;
  return slopes;
}

// Only the lower half is filled.
class NormalSums {
 public:
  explicit NormalSums(std::size_t poses)
      : size_(3 * (static_cast<Eigen::Index>(poses) - 1)), gradient_(Eigen::VectorXd::Zero(size_)) {
    for (Eigen::Index i = 0; i < size_; ++i) triplets_.emplace_back(i, i, kHold);
  }

  void add(const PoseEdge& edge, const std::vector<Pose2>& poses, double weight) {
    const Pose2 &from = poses[edge.from], &to = poses[edge.to];
    const Slopes slopes = slopes_of(from, to);
    const Eigen::Matrix3d information =
        weight * edge.T_from_to.covariance.llt().solve(Eigen::Matrix3d::Identity());
    const Eigen::Vector3d pull = information * miss(edge, from, to);
    add_pull(edge.from, slopes.from.transpose() * pull);
    add_pull(edge.to, slopes.to.transpose() * pull);
    add_block(edge.from, edge.from, slopes.from.transpose() * information * slopes.from);
    add_block(edge.to, edge.to, slopes.to.transpose() * information * slopes.to);
    if (edge.from > edge.to)
      add_block(edge.from, edge.to, slopes.from.transpose() * information * slopes.to);
    else
      add_block(edge.to, edge.from, slopes.to.transpose() * information * slopes.from);
  }

  Normal normal() const {
    Normal normal{Eigen::SparseMatrix<double>(size_, size_), gradient_};
    normal.information.setFromTriplets(triplets_.begin(), triplets_.end());
    return normal;
  }

 private:
  static Eigen::Index first_of(std::size_t pose) {
    return 3 * (static_cast<Eigen::Index>(pose) - 1);
  }

  void add_pull(std::size_t pose, const Eigen::Vector3d& pull) {
    if (pose > 0) gradient_.segment<3>(first_of(pose)) += pull;
  }

  void add_block(std::size_t row, std::size_t column, const Eigen::Matrix3d& block) {
    if (row == 0 || column == 0) return;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (row != column || i >= j)
          triplets_.emplace_back(first_of(row) + i, first_of(column) + j, block(i, j));
  }

  Eigen::Index size_;
  Eigen::VectorXd gradient_;
  Triplets triplets_;
};

Normal normal_of(const std::vector<Pose2>& poses, std::span<const PoseEdge> trusted,
                 std::span<const PoseEdge> doubted, Kernel kernel) {
  NormalSums sums(poses.size());
  for (const PoseEdge& edge : trusted) sums.add(edge, poses, 1.0);
  for (const PoseEdge& edge : doubted)
    sums.add(edge, poses, weight(kernel, distance2(edge, poses)));
  return sums.normal();
}

void move(const Eigen::VectorXd& step, std::vector<Pose2>& poses) {
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const auto own = step.segment<3>(3 * (static_cast<Eigen::Index>(i) - 1));
    Pose2& pose = poses[i];
    pose = {pose.x_m + own.x(), pose.y_m + own.y(), wrap_angle(pose.yaw_rad + own.z())};
  }
}

double in_steps(double value, double step) { return step * std::round(value / step); }

}  // namespace

double weight(Kernel kernel, double distance2) {
  const double share = kScale2 / (kScale2 + distance2);
  switch (kernel) {
    case Kernel::kCauchy:
      return share;
    case Kernel::kGemanMcClure:
      return share * share;
    case Kernel::kSquare:
      break;
  }
  return 1.0;
}

std::vector<Pose2> solve(std::vector<Pose2> poses, std::span<const PoseEdge> trusted,
                         std::span<const PoseEdge> doubted, Kernel kernel) {
  if (poses.size() < 2) return poses;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors;
  for (int i = 0; i < kMostSteps; ++i) {
    const Normal normal = normal_of(poses, trusted, doubted, kernel);
    if (i == 0) factors.analyzePattern(normal.information);
    factors.factorize(normal.information);
    VOXLIST_CHECK(factors.info() == Eigen::Success, "edges need covariances that are definite");
    const Eigen::VectorXd step = -factors.solve(normal.gradient);
    move(step, poses);
    if (step.cwiseAbs().maxCoeff() < kConverged) break;
  }
  return poses;
}

Pose2 rounded(const Pose2& pose) {
  constexpr double kStep_m = 1e-4, kStep_rad = 1e-3 * std::numbers::pi / 180.0;
  return {in_steps(pose.x_m, kStep_m), in_steps(pose.y_m, kStep_m),
          in_steps(pose.yaw_rad, kStep_rad)};
}

}  // namespace voxlist::mapping
