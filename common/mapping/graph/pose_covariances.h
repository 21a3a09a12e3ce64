#pragma once

#include <span>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/mapping/graph/pose_edge.h"

namespace voxlist::mapping {

/// How sure poses are that edges hold, each by itself, and beside the first one, which is exact: of
/// (x, y, yaw) in the map's axes, m^2, m rad, rad^2. A pose that no edge holds is off by 1 km. The
/// doubted edges count by Geman and McClure's kernel, as in the last solve. 10,000 poses take some
/// 0.2 s.
std::vector<Eigen::Matrix3d> covariances(const std::vector<Pose2>& poses,
                                         std::span<const PoseEdge> trusted,
                                         std::span<const PoseEdge> doubted = {});

/// The same of scans that were tracked in a map of keyframes: each is as sure as the keyframe
/// nearest to it is, there; and, where it is not that keyframe, by `beside` less (m, rad; standard
/// deviations). Precondition: there is a keyframe.
std::vector<Eigen::Matrix3d> covariances_of(std::span<const StampedPose3> scans,
                                            std::span<const StampedPose3> keyframes,
                                            std::span<const Eigen::Matrix3d> covariances,
                                            const Eigen::Vector3d& beside);

}  // namespace voxlist::mapping
