#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>

#include "voxlist/matching/engines/matcher.h"
#include "voxlist/matching/search/global_search.h"
#include "voxlist/matching/surfaces/surfels.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::matching {

/// Finds a scan anywhere in a map, without a guess. Both maps must outlive it.
class GlobalMatcher {
 public:
  GlobalMatcher(const OccupancyMap& map, const SurfelMap& surfels, const MatcherConfig& config);

  Match match(const Cloud& scan) { return match(scan, kModeRatio); }

  /// With modes that overlap less.
  Match match_rivals(const Cloud& scan) { return match(scan, kRivalRatio); }

  /// The next match makes the map ready again.
  void map_changed();

 private:
  // Of the best overlap: the true pose has as much, be it the first or not; and what another
  // building hardly leaves to the second best place.
  static constexpr double kModeRatio = 0.88, kRivalRatio = 0.78;

  Match match(const Cloud& scan, double mode_ratio);
  double reach_m(std::span<const Eigen::Vector3f> points) const;
  const GlobalMap& map_for(double reach_m);

  const OccupancyMap& map_;
  const SurfelMap& surfels_;
  const MatcherConfig config_;
  MapRevision revision_;  // of the map that the members below were made of
  std::optional<EvidenceMap> evidence_;
  std::optional<double> closed_cell_m_;
  std::map<double, std::unique_ptr<const GlobalMap>> maps_;  // by reach
};

}  // namespace voxlist::matching
