#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "voxlist/matching/counting/coarse_sweep.h"
#include "voxlist/matching/counting/tolerant_map.h"
#include "voxlist/matching/scan/prepared_scan.h"
#include "voxlist/matching/search/search_result.h"

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

  const TolerantMap& tolerant() const { return tolerant_; }
  const CoarseMap& coarse() const { return coarse_; }

  /// The points of a scan (base, m) that tell poses apart: within reach, and not in layers that the
  /// map fills (floor, ceiling) unless nothing else is there; thinned as in
  /// PreparedScan::search_points(). At most `most` and kMostSearchPoints, spread evenly, and so is
  /// any first part of them.
  std::vector<Eigen::Vector3f> choose_points(const PreparedScan& scan, std::size_t most) const;

 private:
  std::vector<std::uint32_t> telling(const PreparedScan& scan) const;

  TolerantMap tolerant_;
  CoarseMap coarse_;
};

/// Finds the poses of the whole map, every heading, at which most points fall into cells of the
/// tolerant map, on the lattice of its cells and of angles that move no point by more than a cell.
///
/// Nodes of 8 x 8 translations at 8 angles are bounded all at once, by a bit-sliced sweep over the
/// coarse map. The most promising first, as long as their bounds can matter, their translations are
/// counted on blurred maps for all eight angles, then for half of them, down to single poses. Exact
/// and deterministic: the same bits with any number of threads and any instructions.
/// config.max_nodes bounds the nodes that are searched pose by pose, unless these hit nothing.
/// Throws std::invalid_argument for more than kMostSearchPoints or a point beyond the map's reach:
/// GlobalMap::choose_points gives neither.
SearchResult global_search(const GlobalMap& map, std::span<const Eigen::Vector3f> points,
                           const SearchConfig& config,
                           Instructions instructions = best_instructions());

}  // namespace voxlist::matching
