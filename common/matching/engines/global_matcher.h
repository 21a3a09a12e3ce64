#pragma once

#include <map>
#include <memory>
#include <optional>

#include "voxlist/matching/engines/matcher.h"
#include "voxlist/matching/search/global_search.h"
#include "voxlist/matching/surfaces/surfels.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::matching {

/// Modes of a match of the whole map overlap at least this share of what the best does: the true
/// pose has as much, be it the first or not.
inline constexpr double kModeRatio = 0.88;

/// Modes of a match for rivals overlap at least this share: what another building hardly leaves to
/// its second-best mode.
inline constexpr double kRivalRatio = 0.78;

/// Finds a scan anywhere in a map, without a guess. Both maps must outlive it.
class GlobalMatcher {
 public:
  GlobalMatcher(const OccupancyMap& map, const SurfelMap& surfels, const MatcherConfig& config);

  Match match(const PreparedScan& scan, const EvidenceMap& evidence) {
    return match(scan, evidence, kModeRatio);
  }

  /// Also lists modes that overlap less.
  Match match_rivals(const PreparedScan& scan, const EvidenceMap& evidence) {
    return match(scan, evidence, kRivalRatio);
  }

  /// The next match makes the map ready again.
  void map_changed();

 private:
  Match match(const PreparedScan& scan, const EvidenceMap& evidence, double mode_ratio);
  const GlobalMap& map_for(double reach_m);

  const OccupancyMap& map_;
  const SurfelMap& surfels_;
  const MatcherConfig config_;
  MapRevision revision_;  // of the map that the members below were made of
  std::optional<double> closed_cell_m_;
  std::map<double, std::unique_ptr<const GlobalMap>> maps_;  // by reach
};

}  // namespace voxlist::matching
