#include "matching/window_matcher.h"

#include <algorithm>

#include "matching/match_modes.h"

namespace voxlist {
namespace {

std::int64_t volume_of(const Pyramid& pyramid) {
  const Voxel size{pyramid.end().x - pyramid.lowest().x, pyramid.end().y - pyramid.lowest().y,
                   pyramid.end().z - pyramid.lowest().z};
  return std::int64_t{size.x} * size.y * size.z;
}

}  // namespace

WindowMatcher::WindowMatcher(const OccupancyMap& map, const SurfelMap& surfels,
                             const MatcherConfig& config)
    : map_(map), surfels_(surfels), config_(config) {}

Match WindowMatcher::match(const Cloud& cloud, const PoseWindow& window) {
  const MatchPoints scan = chosen_points(cloud.points, config_, 0.2, config_.search_points);
  if (scan.points.size() < kFewestMatchPoints) return {};
  if (!window_map_)
    window_map_.emplace(map_.occupied,
                        PyramidConfig{.resolution_m = config_.window_resolution_m, .levels = 3});
  SearchConfig config{.max_nodes = config_.max_nodes};
  // Slips of less than a step of the robot matter here.
  config.mode_ratio = 0.9;
  config.mode_distance_m = 0.3;
  config.mode_turn_rad = 0.1;
  const SearchResult found = search(*window_map_, scan, window, config);
  Match match;
  match.certified = found.certified;
  match.complete = found.complete;
  match.poses_examined = found.poses_examined;
  if (found.modes.empty()) return match;
  std::vector<MatchMode> candidates = candidates_of(found, scan.points.size());
  candidates.push_back(candidate(window.center, overlap_at(window.center, scan)));
  match.modes = refined_by_fit(
      surfels_, chosen_points(cloud.points, config_, 0.1, config_.refine_points).points,
      std::move(candidates));
  const Pyramid& pyramid = window_map_->pyramid();
  match.significance_log10 =
      log10_significance(volume_of(pyramid), pyramid.occupied_cells(), scan.points.size(),
                         found.modes.front().overlap, found.lattice_poses);
  return match;
}

// Share of the points in occupied cells. The prediction itself is refined too: within half a
// lattice step it may be nearer to the other face of a thin wall than the lattice's best pose is.
double WindowMatcher::overlap_at(const Pose2& pose, const MatchPoints& scan) const {
  const Pyramid& pyramid = window_map_->pyramid();
  const auto hits = std::count_if(scan.points.begin(), scan.points.end(), [&](const auto& p) {
    const Eigen::Vector3d p_map = pose * p.template cast<double>();
    return pyramid.level(0).test(voxel_at(p_map, pyramid.resolution_m()));
  });
  return static_cast<double>(hits) / static_cast<double>(scan.points.size());
}

}  // namespace voxlist
