#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/pose.h"
#include "matching/match_points.h"
#include "matching/sweep.h"
#include "voxels/pyramid.h"

namespace voxlist {

/// A map made ready for searching: rebuild it after the map has changed. Reading from several
/// threads is safe.
class SearchMap {
 public:
  explicit SearchMap(const VoxelMap& map, const PyramidConfig& config = {})
      : pyramid_(map, config), top_(pyramid_.level(pyramid_.top()), 1 << pyramid_.top()) {}

  const Pyramid& pyramid() const { return pyramid_; }
  /// The pyramid's top level, for sweeps by whole nodes.
  const StridedGrid& top() const { return top_; }

 private:
  Pyramid pyramid_;
  StridedGrid top_;
};

/// The poses to search: those within half_* of the centre, on each coordinate.
struct PoseWindow {
  Pose2 center;
  double half_x_m = 0.0;
  double half_y_m = 0.0;
  /// pi or more: every heading.
  double half_yaw_rad = 0.0;
};

/// Every pose whose origin lies over the map's box, every heading.
PoseWindow whole_map(const SearchMap& map);

struct SearchConfig {
  /// Modes reported beside the best one overlap at least this share of the best overlap.
  double mode_ratio = 0.8;
  /// Most modes reported.
  std::size_t max_modes = 8;
  /// Two poses nearer than this, both in distance and in heading, are one mode.
  double mode_distance_m = 0.5;
  double mode_turn_rad = 0.2;
  /// Most nodes expanded; then the search stops early and says so.
  std::int64_t max_nodes = 200'000;
};

/// A local best of the overlap.
struct OverlapMode {
  Pose2 pose;
  /// Points whose cell is occupied in the tolerant map.
  int overlap = 0;
};

struct SearchResult {
  /// Best first; empty when the scan or the map is empty.
  std::vector<OverlapMode> modes;
  /// No pose of the window's lattice overlaps more than the first mode. False: the node budget
  /// ended the search.
  bool certified = false;
  /// Every distinct mode of at least mode_ratio is listed, up to max_modes. False: the node budget
  /// ended the search.
  bool complete = false;
  /// No unseen pose overlaps more than this (equal to the best overlap when certified).
  int bound = 0;
  /// Poses of the lattice that was searched.
  double lattice_poses = 0.0;
  /// Nodes and poses whose overlap was counted.
  std::int64_t poses_examined = 0;
};

/// Best-first branch and bound over the lattice of poses: translations by the pyramid's resolution
/// e, angles by e / R (paper, equation 1), R the radius of the points. Exact and deterministic: the
/// top level is swept as a whole, nodes are then opened in the order of their bounds (ties by
/// position), so the first pose that comes out is a best one. Goes on until no node can hold a
/// distinct mode of at least mode_ratio of it.
SearchResult search(const SearchMap& map, const MatchPoints& points, const PoseWindow& window,
                    const SearchConfig& config);

}  // namespace voxlist
