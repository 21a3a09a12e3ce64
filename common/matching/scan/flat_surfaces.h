#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace voxlist::matching {

/// For each point of a scan whether it lies on a surface that lies flat (floor, ceiling, table
/// top): such points match wherever the robot is, and tell no pose (x, y, yaw) from another. Only
/// the points of `indices` are looked at, and must lie in the voxels' lattice.
std::vector<bool> on_flat_surfaces(std::span<const Eigen::Vector3f> points,
                                   std::span<const std::uint32_t> indices);

}  // namespace voxlist::matching
