#include "voxlist/matching/engines/global_matcher.h"

#include <algorithm>

#include "voxlist/matching/engines/match_modes.h"
#include "voxlist/matching/search/map_density.h"
#include "voxlist/matching/search/overlap_peak.h"
#include "voxlist/system/check.h"

namespace voxlist::matching {
namespace {

// Most modes of a search, each refined once: of rooms that are alike, the right one must be among
// them, and hotel_floor has 32. Time grows with it where a scan fits many poses.
constexpr std::size_t kMostModes = 48;
// Two poses of the lattice that are nearer than this (m, rad) are one mode: about the reach of the
// refinement, so that none is hidden that would be refined elsewhere. With 0.12 m or 0.5 m, and
// turns in proportion, bench_global 60x40 30 1 gives the same.
constexpr double kModeDistance_m = 0.25, kModeTurn_rad = 0.1;
// Kept for the second refinement are the best modes, and all whose support comes this near to the
// first one's.
constexpr std::size_t kBestModes = 8;
constexpr double kNearSupport = 0.08;

SearchConfig search_config(const MatcherConfig& config, double mode_ratio) {
  return {.mode_ratio = mode_ratio,
          .max_modes = kMostModes,
          .mode_distance_m = kModeDistance_m,
          .mode_turn_rad = kModeTurn_rad,
          .max_nodes = config.max_nodes};
}

// Moves each mode to the middle of its peak of counts.
void move_to_peaks(const DilatedMap& map, const std::vector<Eigen::Vector3f>& points,
                   std::vector<OverlapMode>& modes) {
  for (OverlapMode& mode : modes) mode.pose = middle_of_peak(map, points, mode.pose);
}

// Drops ranked modes that will not become the best.
void keep_contenders(std::vector<MatchMode>& modes) {
  std::size_t kept = std::min(modes.size(), kBestModes);
  while (kept < modes.size() && modes[kept].support > modes.front().support - kNearSupport) ++kept;
  modes.resize(kept);
}

double significance_log10(const DilatedMap& cells, std::size_t points, const SearchResult& found) {
  return log10_significance(std::int64_t{cells.size_x()} * cells.size_y() * cells.size_z(),
                            cells.occupied_cells(), points, found.modes.front().overlap,
                            found.lattice_poses);
}

}  // namespace

GlobalMatcher::GlobalMatcher(const OccupancyMap& map, const SurfelMap& surfels,
                             const MatcherConfig& config)
    : map_(map), surfels_(surfels), config_(config), revision_(map.revision()) {}

Match GlobalMatcher::match(const PreparedScan& scan, const EvidenceMap& evidence,
                           double mode_ratio) {
  VOXLIST_CHECK(map_.revision() == revision_,
                "the map has changed and map_changed() was not called");
  const GlobalMap& map = map_for(scan.reach_m());
  const auto points = map.choose_points(scan, static_cast<std::size_t>(config_.search_points));
  if (points.size() < kFewestMatchPoints) return {};
  SearchResult found = global_search(map, points, search_config(config_, mode_ratio));
  Match match(found);
  match.unseen = found.complete ? mode_ratio : 1.0;
  if (found.modes.empty()) return match;
  move_to_peaks(map.dilated(), points, found.modes);
  match.modes = refined(surfels_, scan.few_points(), candidates_of(found, points.size()));
  rank(evidence, scan.few_rays(), match.modes);
  keep_contenders(match.modes);
  match.modes = refined(surfels_, scan.points(), match.modes);
  match.significance_log10 = significance_log10(map.dilated(), points.size(), found);
  return match;
}

void GlobalMatcher::map_changed() {
  revision_ = map_.revision();
  maps_.clear();
  closed_cell_m_.reset();
}

const GlobalMap& GlobalMatcher::map_for(double reach_m) {
  const auto [found, added] = maps_.try_emplace(reach_m);
  if (!added) return *found->second;
  if (!closed_cell_m_) closed_cell_m_ = closed_cell_m(map_.occupied);
  double cell_m = config_.resolution_m;
  while (cell_m < *closed_cell_m_) cell_m *= 2.0;
  found->second = std::make_unique<GlobalMap>(map_.occupied, cell_m, reach_m);
  return *found->second;
}

}  // namespace voxlist::matching
