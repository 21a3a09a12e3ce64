#include "voxlist/matching/engines/window_matcher.h"

#include <algorithm>

#include "voxlist/matching/engines/match_modes.h"
#include "voxlist/matching/search/window_search.h"

namespace voxlist::matching {
namespace {

// Slips of less than a step of the robot matter in a window: modes overlap at least this share of
// what the best does, and poses nearer than this distance and turn are one mode.
constexpr SearchConfig kModes{.mode_ratio = 0.9, .mode_distance_m = 0.3, .mode_turn_rad = 0.1};

// A first refinement ends at steps of this (m) and leaves a millimetre or two to a second one.
constexpr RefineConfig kRough{.converged_m = 1e-3};

// Modes whose inlier ratio is so much below the best one's are left as the first refinement has
// them: the second moves a pose by millimetres, and its inlier ratio by less than this.
constexpr double kContends = 0.05;

void sort_by_inliers(std::vector<MatchMode>& modes) {
  std::stable_sort(modes.begin(), modes.end(),
                   [](const auto& a, const auto& b) { return a.inlier_ratio > b.inlier_ratio; });
}

// Refines those of the sorted modes again that may be best in the end.
void refine_contenders(const SurfelMap& surfels, const MatchPoints& points,
                       std::vector<MatchMode>& modes) {
  const double least = modes.front().inlier_ratio - kContends;
  const auto rest = std::find_if(modes.begin(), modes.end(),
                                 [&](const MatchMode& mode) { return mode.inlier_ratio < least; });
  const std::vector<MatchMode> others(rest, modes.end());
  modes.erase(rest, modes.end());
  modes = refined(surfels, points, modes);
  std::copy_if(others.begin(), others.end(), std::back_inserter(modes),
               [&](const MatchMode& mode) { return !holds(modes, mode.pose); });
  sort_by_inliers(modes);
}

}  // namespace

WindowMatcher::WindowMatcher(const OccupancyMap& map, const SurfelMap& surfels)
    : surfels_(surfels), cell_m_(WindowMap::cell_m(map.occupied)), window_map_(map.occupied) {}

Match WindowMatcher::match(const PreparedScan& scan, const PoseWindow& window) {
  if (scan.points().points.size() < kFewestMatchPoints) return {};
  const MatchPoints& counted = scan.few_points();
  const CellRectangle ground = needed_ground(cell_m_, counted.radius_m, window);
  window_map_.hold(ground);
  const SearchResult found = search_window(window_map_, cell_m_, counted, window, kModes);
  Match match(found);
  if (found.modes.empty()) return match;
  // Most of the way with few points: many candidates go to the same place.
  match.modes = refined(surfels_, counted, candidates_of(found, counted.points.size()), kRough);
  sort_by_inliers(match.modes);
  refine_contenders(surfels_, scan.points(), match.modes);
  match.significance_log10 = significance_log10(ground, counted.points.size(), found);
  return match;
}

double WindowMatcher::significance_log10(const CellRectangle& ground, std::size_t points,
                                         const SearchResult& found) const {
  const WindowMap::Count count = window_map_.count(ground);
  return log10_significance(count.cells, count.occupied, points, found.modes.front().overlap,
                            found.lattice_poses);
}

}  // namespace voxlist::matching
