#include "voxlist/matching/engines/window_matcher.h"

#include <algorithm>

#include "voxlist/matching/engines/match_modes.h"
#include "voxlist/matching/search/window_search.h"

namespace voxlist::matching {
namespace {

// Slips of less than a step of the robot matter in a window: modes overlap at least this share of
// what the best does, and poses nearer than this distance and turn are one mode.
constexpr SearchConfig kModes{.mode_ratio = 0.9, .mode_distance_m = 0.3, .mode_turn_rad = 0.1};

// As rivals of a tracked pose count modes that overlap so much less: the more they are, the surer
// it is that none was overlooked, and the longer it takes.
constexpr SearchConfig kRivals{.mode_ratio = 0.8, .mode_distance_m = 0.3, .mode_turn_rad = 0.1};

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
    : map_(map.occupied), surfels_(surfels), cell_m_(WindowMap::cell_m(map.occupied)) {}

void WindowMatcher::map_changed(const ChangedBlocks& changed) {
  for (const auto& map : maps_)
    if (map) map->map_changed(changed.occupied);
}

Match WindowMatcher::match(const PreparedScan& scan, const PoseWindow& window) {
  if (scan.points().points.size() < kFewestMatchPoints) return {};
  WindowMap& map = map_for(scan);
  const SearchResult found = search(map, scan, window, kModes);
  Match match(found);
  if (found.modes.empty()) return match;
  // Most of the way with few points: many candidates go to the same place.
  const MatchPoints& few = scan.few_points();
  match.modes = refined(surfels_, few, candidates_of(found, few.points.size()), kRough);
  sort_by_inliers(match.modes);
  refine_contenders(surfels_, scan.points(), match.modes);
  match.significance_log10 = significance_log10(map, scan, window, found);
  return match;
}

Match WindowMatcher::track(const PreparedScan& scan, const PoseWindow& window,
                           const UncertainPose& prior) {
  if (scan.points().points.size() < kFewestMatchPoints) return {};
  WindowMap& map = map_for(scan);
  const SearchResult found = search(map, scan, window, kRivals);
  Match match(found);
  const MatchPoints& few = scan.few_points();
  auto candidates = candidates_of(found, few.points.size());
  candidates.push_back(candidate(prior.pose, overlap_ratio_at(map, scan, prior.pose)));
  match.modes =
      refined(surfels_, scan.points(), refined(surfels_, few, candidates, prior, kRough), prior);
  if (!found.modes.empty()) match.significance_log10 = significance_log10(map, scan, window, found);
  return match;
}

WindowMap& WindowMatcher::map_for(const PreparedScan& scan) {
  const auto doublings = static_cast<std::size_t>(
      scan.layer_doublings(kBlockEdge * map_.resolution_m(), WindowMap::kMostDoublings));
  auto& map = maps_[doublings];
  if (!map) map = std::make_unique<WindowMap>(map_, static_cast<int>(doublings));
  return *map;
}

SearchResult WindowMatcher::search(WindowMap& map, const PreparedScan& scan,
                                   const PoseWindow& window, const SearchConfig& config) const {
  map.hold(needed_ground(cell_m_, scan.few_points().radius_m, window));
  return search_window(map, cell_m_, scan.few_points(), window, config);
}

double WindowMatcher::overlap_ratio_at(WindowMap& map, const PreparedScan& scan,
                                       const Pose2& pose) const {
  const SearchResult found = search(map, scan, {pose, 0.0, 0.0, 0.0}, kModes);
  return found.modes.empty() ? 0.0
                             : static_cast<double>(found.modes.front().overlap) /
                                   static_cast<double>(scan.few_points().points.size());
}

double WindowMatcher::significance_log10(const WindowMap& map, const PreparedScan& scan,
                                         const PoseWindow& window,
                                         const SearchResult& found) const {
  const WindowMap::Count count =
      map.count(needed_ground(cell_m_, scan.few_points().radius_m, window));
  return log10_significance(count.cells, count.occupied, scan.few_points().points.size(),
                            found.modes.front().overlap, found.lattice_poses);
}

}  // namespace voxlist::matching
