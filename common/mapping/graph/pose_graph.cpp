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

void add(const PoseEdge& edge, const std::vector<Pose2>& poses, double weight,
         NormalEquations<3>& equations) {
  const Pose2 &from = poses[edge.from], &to = poses[edge.to];
  const Slopes slopes = slopes_of(from, to);
  const Eigen::Matrix3d information =
      weight * edge.T_from_to.covariance.llt().solve(Eigen::Matrix3d::Identity());
  equations.add(edge.from, slopes.from, edge.to, slopes.to, information, miss(edge, from, to));
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

NormalEquations<3> equations_of(const std::vector<Pose2>& poses, std::span<const PoseEdge> trusted,
                                std::span<const PoseEdge> doubted, Kernel kernel) {
  NormalEquations<3> equations(poses.size(), kHold);
  for (const PoseEdge& edge : trusted) add(edge, poses, 1.0, equations);
  for (const PoseEdge& edge : doubted)
    add(edge, poses, weight(kernel, distance2(edge, poses)), equations);
  return equations;
}

double chi2(const std::vector<Pose2>& poses, std::span<const PoseEdge> edges) {
  double sum = 0.0;
  for (const PoseEdge& edge : edges) sum += distance2(edge, poses);
  return sum;
}

std::vector<Pose2> solve(std::vector<Pose2> poses, std::span<const PoseEdge> trusted,
                         std::span<const PoseEdge> doubted, Kernel kernel) {
  if (poses.size() < 2) return poses;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors;
  for (int i = 0; i < kMostSteps; ++i) {
    const NormalEquations<3> equations = equations_of(poses, trusted, doubted, kernel);
    const Eigen::SparseMatrix<double> information = equations.information();
    if (i == 0) factors.analyzePattern(information);
    factors.factorize(information);
    VOXLIST_CHECK(factors.info() == Eigen::Success, "edges need covariances that are definite");
    const Eigen::VectorXd step = -factors.solve(equations.gradient());
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
