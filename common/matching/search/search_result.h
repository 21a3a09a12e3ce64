#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/geometry/pose.h"

namespace voxlist::matching {

/// Most nodes that a search expands, unless it is told otherwise: 0.2 to 1 s of one thread. In a
/// changed floor of 200 x 150 m, 65 % of searches end there; on floors of 60 x 40 m none of 120,
/// but 12 of 60 for scans of another building (bench_global 60x40 30, seeds 1 and 4). Fewer: faster
/// where a scan is foreign, and more searches without a certificate.
inline constexpr int kMostNodes = 100'000;

/// What is asked of a search for the poses of a lattice that overlap a map most.
struct SearchConfig {
  /// Modes reported beside the best one overlap at least this share of the best overlap. Lower:
  /// more rivals are known, and searches take longer. Engines set their own.
  double mode_ratio = 0.8;
  /// Most modes reported.
  std::size_t max_modes = 8;
  /// Two poses nearer than this, both in distance and in heading, are one mode: about a robot's
  /// size. Engines set their own.
  double mode_distance_m = 0.5;
  double mode_turn_rad = 0.2;
  /// Most nodes expanded; then the search stops early and says so.
  std::int64_t max_nodes = kMostNodes;
};

/// A local best of the overlap.
struct OverlapMode {
  Pose2 pose;
  /// Points whose cell is occupied in the dilated map.
  int overlap = 0;
};

/// How far a search went.
struct SearchReport {
  /// No pose of the lattice overlaps more than the first mode. False: the node budget ended the
  /// search.
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

/// What a search found.
struct SearchResult : SearchReport {
  /// Best first; empty when the scan or the map is empty.
  std::vector<OverlapMode> modes;
};

}  // namespace voxlist::matching
