#pragma once

#include <filesystem>
#include <vector>

#include "voxlist/drawing/map_picture.h"
#include "voxlist/geometry/cloud.h"
#include "voxlist/mapping/graph/stored_graph.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::mapping {

/// Name of the poses' covariances in a map folder, beside trajectory.tum.
inline constexpr const char* kCovarianceFile = "trajectory_covariance.txt";

/// The pictures of a map of more voxels than this show cells of twice the edge, and so on: map.ply
/// takes 15 bytes for each, and 200 x 150 m have 50 million.
inline constexpr std::size_t kMostViewed = 10'000'000;

/// Writes into a map folder what people and other programs look at, each file atomically: map.png
/// (from above and from the side, with the path and what is free), map.ply (voxel centres, coloured
/// by height), trajectory.tum (the poses). Covariances of the poses of before are taken away. Loops
/// that were `closed` are drawn as well. Throws FileError.
void write_map_views(const std::filesystem::path& folder, const OccupancyMap& map,
                     const std::vector<StampedPose3>& trajectory,
                     const drawing::ClosedLoops& closed = {},
                     std::size_t most_voxels = kMostViewed);

/// Writes how sure the poses of trajectory.tum are, by a graph of all keyframes: those as what
/// holds them says, other scans as the keyframe nearest to them. Nothing where the graph says of a
/// keyframe nothing. Throws FileError.
void write_covariances(const std::filesystem::path& folder, const StoredGraph& graph,
                       const std::vector<StampedPose3>& trajectory);

}  // namespace voxlist::mapping
