#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "voxlist/matching/counting/coarse_sweep.h"
#include "voxlist/matching/counting/dilated_map.h"
#include "voxlist/matching/scan/prepared_scan.h"

namespace voxlist::matching {

/// Most points that a search counts.
inline constexpr std::size_t kMostSearchPoints = (std::size_t{1} << kCountPlanes) - 1;

/// A map made ready for searching all of it: rebuild it after the map has changed. Reading from
/// several threads is safe.
class GlobalMap {
 public:
  /// `finest_m`: edge of the cells and lattice of the poses, doubled until `reach_m`, the farthest
  /// point of the scans to come, is at most 800 cells: farther points ask for finer angles.
  GlobalMap(const VoxelMap& map, double finest_m, double reach_m);

  const DilatedMap& dilated() const { return dilated_; }
  const CoarseMap& coarse() const { return coarse_; }

  /// The points of a scan (base, m) that tell poses apart: within reach, and not in layers that the
  /// map fills (floor, ceiling) unless nothing else is there; thinned as in
  /// PreparedScan::search_points(). At most `most` and kMostSearchPoints, spread evenly, and so is
  /// any first part of them.
  std::vector<Eigen::Vector3f> choose_points(const PreparedScan& scan, std::size_t most) const;

  /// Whether a search can count the point: false for what is not finite, too.
  bool within_reach(const Eigen::Vector3f& p) const;

 private:
  std::vector<std::uint32_t> telling(const PreparedScan& scan) const;

  DilatedMap dilated_;
  CoarseMap coarse_;
};

}  // namespace voxlist::matching
