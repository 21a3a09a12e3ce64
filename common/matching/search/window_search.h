#pragma once

#include "voxlist/matching/counting/coarse_sweep.h"
#include "voxlist/matching/counting/window_map.h"
#include "voxlist/matching/scan/match_points.h"
#include "voxlist/matching/search/pose_window.h"
#include "voxlist/matching/search/search_result.h"

namespace voxlist::matching {

/// Counts the overlap of every pose of a window's lattice: translations by a cell, angles by a cell
/// at the farthest point's range. So the best is the best; the same for any number of threads.
/// `map` must hold needed_ground(). At most kMostSearchPoints points.
SearchResult search_window(const WindowMap& map, double cell_m, const MatchPoints& points,
                           const PoseWindow& window, const SearchConfig& config,
                           Instructions instructions = best_instructions());

/// The ground on which points within radius_m of base can come to lie at the window's poses.
CellRectangle needed_ground(double cell_m, double radius_m, const PoseWindow& window);

}  // namespace voxlist::matching
