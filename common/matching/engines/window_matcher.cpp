#include "voxlist/matching/engines/window_matcher.h"

#include <algorithm>

#include "voxlist/matching/engines/match_modes.h"
#include "voxlist/matching/search/window_search.h"

namespace voxlist::matching {
namespace {

// Points that are counted: more tell poses no better apart, the lattice is too coarse for that.
constexpr std::size_t kCountedPoints = 400;

// A first refinement leaves a millimetre or two to a second one.
constexpr RefineConfig kRough{.converged_m = 1e-3};
// Modes that fit so much worse than the best are left as the first refinement has them.
constexpr double kContends = 0.05;

void by_fit(std::vector<MatchMode>& modes) {
  std::stable_sort(modes.begin(), modes.end(),
                   [](const auto& a, const auto& b) { return a.fit > b.fit; });
}

}  // namespace

WindowMatcher::WindowMatcher(const OccupancyMap& map, const SurfelMap& surfels,
                             const MatcherConfig& config)
    : surfels_(surfels),
      config_(config),
      cell_m_(WindowMap::cell_m(map.occupied)),
      window_map_(map.occupied) {}

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
  window_map_.hold(ground);
  const SearchResult found = search_window(window_map_, cell_m_, counted, window, config);
  Match match;
  match.certified = found.certified;
  match.complete = found.complete;
  match.poses_examined = found.poses_examined;
  if (found.modes.empty()) return match;
  // Most of the way with few points: many candidates go to the same place.
  match.modes = refined(surfels_, counted, candidates_of(found, counted.points.size()), kRough);
  by_fit(match.modes);
  // The rest with all: of those that may be best in the end.
  const double least = match.modes.front().fit - kContends;
  const auto rest = std::find_if(match.modes.begin(), match.modes.end(),
                                 [&](const MatchMode& mode) { return mode.fit < least; });
  std::vector<MatchMode> others(rest, match.modes.end());
  match.modes.erase(rest, match.modes.end());
  match.modes = refined(surfels_, scan, match.modes);
  std::copy_if(others.begin(), others.end(), std::back_inserter(match.modes),
               [&](const MatchMode& mode) { return !holds(match.modes, mode.pose); });
  by_fit(match.modes);
  const WindowMap::Count count = window_map_.count(ground);
  match.significance_log10 = log10_significance(count.cells, count.occupied, counted.points.size(),
                                                found.modes.front().overlap, found.lattice_poses);
  return match;
}

}  // namespace voxlist::matching
