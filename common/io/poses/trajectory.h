#pragma once

#include <filesystem>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/io/poses/pose_file.h"

namespace voxlist::io {

/// Reads poses in TUM's format: lines "t x y z qx qy qz qw" (t in seconds, metres, # before
/// comments), in the file's order. Throws FileError, with the line, on what is no such line, is not
/// finite, or is no unit quaternion (1 % off is mended).
std::vector<StampedPose3> read_tum(const std::filesystem::path& path);

/// A table's poses with their times, in its order.
std::vector<StampedPose3> trajectory_of(const PoseTable& table);

/// Writes poses in TUM's format, atomically: times to the microsecond, positions and quaternions to
/// 9 decimals. Throws FileError.
void write_tum(const std::filesystem::path& path, const std::vector<StampedPose3>& trajectory);

/// Writes how sure the poses of a trajectory are, atomically: lines "t xx xy xa yy ya aa" of the
/// covariances of x, y (m) and yaw (a, rad), as the first line says. As many as poses. Throws
/// FileError.
void write_covariances(const std::filesystem::path& path,
                       const std::vector<StampedPose3>& trajectory,
                       const std::vector<Eigen::Matrix3d>& covariances);

}  // namespace voxlist::io
