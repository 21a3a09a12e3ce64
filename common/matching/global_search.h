#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/pose.h"
#include "matching/coarse_sweep.h"
#include "matching/tolerant_map.h"

namespace voxlist {

struct GlobalSearchConfig {
  double mode_ratio = 0.9;
  std::size_t max_modes = 8;
  double mode_distance_m = 0.3;
  double mode_turn_rad = 0.1;
  std::int64_t max_leaves = 100'000;
  Instructions instructions = best_instructions();
};

struct GlobalMode {
  Pose2 pose;
  int overlap = 0;
};

struct GlobalSearchResult {
  std::vector<GlobalMode> modes;
  bool certified = false;
  bool complete = false;
  int bound = 0;
  std::int64_t leaves = 0, nodes = 0;
  double lattice_poses = 0.0;
  double ms_cells = 0, ms_sweep = 0, ms_leaves = 0;
};

GlobalSearchResult global_search(const TolerantMap& map, const CoarseMap& coarse,
                                 std::span<const Eigen::Vector3f> points,
                                 const GlobalSearchConfig& config);

}  // namespace voxlist
