#include "matching/window_matcher.h"

#include <algorithm>

#include "matching/match_modes.h"
#include "matching/window_search.h"

namespace voxlist {
namespace {

// Points that are counted: more tell poses no better apart, the lattice is too coarse for that.
constexpr std::size_t kCountedPoints = 400;

}  // namespace

WindowMatcher::WindowMatcher(const OccupancyMap& map, const SurfelMap& surfels,
                             const MatcherConfig& config)
    : map_(map), surfels_(surfels), config_(config), cell_m_(WindowMap::cell_m(map.occupied)) {}

Match WindowMatcher::match(const Cloud& cloud, const PoseWindow& window) {
  const MatchPoints scan = choose_match_points(
      cloud,
      {.max_range_m = config_.max_range_m, .spacing_m = 0.1, .max_points = config_.refine_points});
  if (scan.points.size() < kFewestMatchPoints) return {};
  const MatchPoints counted = some_of(scan, kCountedPoints);
  SearchConfig config;
  // Slips of less than a step of the robot matter here.
  config.mode_ratio = 0.9;
  config.mode_distance_m = 0.3;
  config.mode_turn_rad = 0.1;
  const CellRectangle ground = needed_ground(cell_m_, counted.radius_m, window);
  const WindowMap& window_map = map_for(ground);
  const SearchResult found = search_window(window_map, cell_m_, counted, window, config);
  Match match;
  match.certified = found.certified;
  match.complete = found.complete;
  match.poses_examined = found.poses_examined;
  if (found.modes.empty()) return match;
  // Most of the way with few points: many candidates go to the same place.
  match.modes = refined(surfels_, counted, candidates_of(found, counted.points.size()));
  match.modes = refined(surfels_, scan, match.modes);
  std::stable_sort(match.modes.begin(), match.modes.end(),
                   [](const auto& a, const auto& b) { return a.fit > b.fit; });
  const WindowMap::Count count = window_map.count(ground);
  match.significance_log10 = log10_significance(count.cells, count.occupied, counted.points.size(),
                                                found.modes.front().overlap, found.lattice_poses);
  return match;
}

void WindowMatcher::map_grew(const ChangedBlocks& grown) {
  if (window_map_ && !window_map_->add(map_.occupied, grown.occupied)) window_map_.reset();
}

const WindowMap& WindowMatcher::map_for(const CellRectangle& needed) {
  if (!window_map_ || !window_map_->ground().holds(needed)) {
    // Somewhat more, so that it serves while the robot moves on.
    constexpr std::int32_t kMore = 32;
    window_map_.emplace(map_.occupied, CellRectangle{needed.low_x - kMore, needed.low_y - kMore,
                                                     needed.end_x + kMore, needed.end_y + kMore});
  }
  return *window_map_;
}

}  // namespace voxlist
