#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace voxlist::mapping {

/// Height (m) of base in the map at each keyframe, by which storeys above each other are told
/// apart. Empty: all are on one.
using DriveHeights = std::vector<double>;

/// Whether two keyframes may be on one floor.
inline bool may_share_floor(const DriveHeights& heights_m, std::size_t a, std::size_t b) {
  // Storeys are farther apart (m), and what a drive's height drifts by is less.
  constexpr double kStorey_m = 1.5;
  return heights_m.empty() || std::abs(heights_m[a] - heights_m[b]) < kStorey_m;
}

}  // namespace voxlist::mapping
