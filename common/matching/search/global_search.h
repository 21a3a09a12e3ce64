#pragma once

#include <Eigen/Core>
#include <span>

#include "voxlist/matching/counting/coarse_sweep.h"
#include "voxlist/matching/search/global_map.h"
#include "voxlist/matching/search/search_result.h"

namespace voxlist::matching {

/// Finds the poses of the whole map, every heading, at which most points fall into cells of the
/// dilated map, on the lattice of its cells and of angles that move no point by more than a cell.
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
