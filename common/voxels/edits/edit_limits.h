#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "voxlist/geometry/pose.h"

namespace voxlist {

/// Most boxes of a map, their shortest edge and their longest, and how much space they may take
/// together: twice a floor of 60 x 40 m. What boxes cost in memory and time follows from it.
inline constexpr std::size_t kMostEdits = 10'000;
inline constexpr double kShortestEdge_m = 0.01, kLongestEdge_m = 100.0;
inline constexpr double kMostEdited_m3 = 12'000.0;

/// Why a map cannot have these boxes, for people; empty: it can.
std::string fault_of(const std::vector<Eigen::AlignedBox3d>& boxes);

/// Whether a map may have moved its boxes so.
bool is_sane_move(const Pose2& T_map_box);

}  // namespace voxlist
