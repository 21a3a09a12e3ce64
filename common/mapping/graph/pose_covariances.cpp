#include "voxlist/mapping/graph/pose_covariances.h"

#include <algorithm>

#include "voxlist/mapping/graph/pose_graph.h"
#include "voxlist/mapping/graph/sparse_inverse.h"
#include "voxlist/system/check.h"

namespace voxlist::mapping {
namespace {

// How an error (m, m, rad) of a pose moves what stands fast beside it.
Eigen::Matrix3d lever(const Pose2& pose, const Pose2& beside) {
  Eigen::Matrix3d lever = Eigen::Matrix3d::Identity();
  lever(0, 2) = pose.y_m - beside.y_m;
  lever(1, 2) = beside.x_m - pose.x_m;
  return lever;
}

std::size_t nearest(std::span<const StampedPose3> keyframes, const StampedPose3& scan) {
  const auto away_m2 = [&](const StampedPose3& keyframe) {
    return (keyframe.pose.translation() - scan.pose.translation()).squaredNorm();
  };
  const auto at =
      std::min_element(keyframes.begin(), keyframes.end(),
                       [&](const auto& a, const auto& b) { return away_m2(a) < away_m2(b); });
  return static_cast<std::size_t>(at - keyframes.begin());
}

}  // namespace

std::vector<Eigen::Matrix3d> covariances(const std::vector<Pose2>& poses,
                                         std::span<const PoseEdge> trusted,
                                         std::span<const PoseEdge> doubted) {
  std::vector<Eigen::Matrix3d> found(poses.size(), Eigen::Matrix3d::Zero());
  if (poses.size() < 2) return found;
  const auto equations = equations_of(poses, trusted, doubted, Kernel::kGemanMcClure);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(equations.information());
  VOXLIST_CHECK(factors.info() == Eigen::Success, "edges need covariances that are definite");
  const SparseInverse inverse(factors);
  for (std::size_t i = 1; i < poses.size(); ++i)
    for (Eigen::Index row = 0; row < 3; ++row)
      for (Eigen::Index column = 0; column < 3; ++column)
        found[i](row, column) =
            inverse(equations.first_of(i) + row, equations.first_of(i) + column);
  return found;
}

std::vector<Eigen::Matrix3d> covariances_of(std::span<const StampedPose3> scans,
                                            std::span<const StampedPose3> keyframes,
                                            std::span<const Eigen::Matrix3d> covariances,
                                            const Eigen::Vector3d& beside) {
  std::vector<Eigen::Matrix3d> found;
  for (const StampedPose3& scan : scans) {
    const std::size_t i = nearest(keyframes, scan);
    const Eigen::Matrix3d moved = lever(to_pose2(keyframes[i].pose), to_pose2(scan.pose));
    found.push_back(moved * covariances[i] * moved.transpose());
    if (scan.utime_us != keyframes[i].utime_us) found.back().diagonal() += beside.cwiseAbs2();
  }
  return found;
}

}  // namespace voxlist::mapping
