#pragma once

#include "voxlist/matching/engines/matcher.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::matching {

/// The paper's filter as an engine, its poses refined as others are.
std::unique_ptr<Matcher> make_filter_matcher(const OccupancyMap& map, const MatcherConfig& config);

}  // namespace voxlist::matching
