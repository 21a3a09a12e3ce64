#pragma once

#include "matching/matcher.h"
#include "voxels/occupancy_map.h"

namespace voxlist {

/// The paper's filter as an engine, its poses refined as others are.
std::unique_ptr<Matcher> make_filter_matcher(const OccupancyMap& map, const MatcherConfig& config);

}  // namespace voxlist
