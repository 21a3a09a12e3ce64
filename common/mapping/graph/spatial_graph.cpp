#include "voxlist/mapping/graph/spatial_graph.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>

#include "voxlist/system/check.h"

namespace voxlist::mapping {
namespace {

// As for planar poses (pose_graph.cpp).
constexpr int kMostSteps = 50;
constexpr double kConverged = 1e-7, kHold = 1e-6;

// How an edge's miss changes with a small step (in the map's axes) of the pose that it comes from;
// with that of the other pose it changes as `to`. Where the edge is nearly met.
struct Slopes {
  Six2 from = Six2::Zero(), to = Six2::Zero();
};

Slopes slopes_of(const Pose3& from, const Pose3& to) {
  const Eigen::Matrix3d turned = from.linear().transpose();
  Slopes slopes;
  slopes.to.topLeftCorner<3, 3>() = slopes.to.bottomRightCorner<3, 3>() = turned;
  slopes.from = -slopes.to;
  slopes.from.topRightCorner<3, 3>() = turned * cross(to.translation() - from.translation());
  return slopes;
}

void add(const SpatialEdge& edge, const std::vector<Pose3>& poses, double weight,
         NormalEquations<6>& equations) {
  const Pose3 &from = poses[edge.from], &to = poses[edge.to];
  const Slopes slopes = slopes_of(from, to);
  const Six2 information = weight * edge.T_from_to.covariance.llt().solve(Six2::Identity());
  equations.add(edge.from, slopes.from, edge.to, slopes.to, information,
                miss(edge.T_from_to.pose, from, to));
}

NormalEquations<6> equations_of(const std::vector<Pose3>& poses,
                                std::span<const SpatialEdge> trusted,
                                std::span<const SpatialEdge> doubted, Kernel kernel) {
  NormalEquations<6> equations(poses.size(), kHold);
  for (const SpatialEdge& edge : trusted) add(edge, poses, 1.0, equations);
  for (const SpatialEdge& edge : doubted)
    add(edge, poses, weight(kernel, distance2(edge, poses)), equations);
  return equations;
}

void move(const Eigen::VectorXd& steps, std::vector<Pose3>& poses) {
  for (std::size_t i = 1; i < poses.size(); ++i)
    poses[i] = stepped(poses[i], steps.segment<6>(NormalEquations<6>::first_of(i)));
}

}  // namespace

std::vector<Pose3> solve(std::vector<Pose3> poses, std::span<const SpatialEdge> trusted,
                         std::span<const SpatialEdge> doubted, Kernel kernel) {
  if (poses.size() < 2) return poses;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors;
  for (int i = 0; i < kMostSteps; ++i) {
    const NormalEquations<6> equations = equations_of(poses, trusted, doubted, kernel);
    const Eigen::SparseMatrix<double> information = equations.information();
    if (i == 0) factors.analyzePattern(information);
    factors.factorize(information);
    VOXLIST_CHECK(factors.info() == Eigen::Success, "edges need covariances that are definite");
    const Eigen::VectorXd steps = -factors.solve(equations.gradient());
    move(steps, poses);
    if (steps.cwiseAbs().maxCoeff() < kConverged) break;
  }
  return poses;
}

Tilt rounded(const Tilt& tilt) {
  // Height and two angles, as x, y and yaw are.
  const Pose2 height = rounded(Pose2{tilt.z_m, 0.0, tilt.roll_rad});
  return {height.x_m, height.yaw_rad, rounded(Pose2{0.0, 0.0, tilt.pitch_rad}).yaw_rad};
}

}  // namespace voxlist::mapping
