#include "voxlist/matching/engines/global_matcher.h"

#include <algorithm>

#include "voxlist/matching/engines/match_modes.h"
#include "voxlist/matching/search/map_density.h"
#include "voxlist/matching/search/overlap_peak.h"
#include "voxlist/system/check.h"

namespace voxlist::matching {
namespace {

// Kept are the best, and all whose support comes near the first one's: of rooms that are alike, the
// right one must be among them.
constexpr std::size_t kModes = 48, kBestModes = 8;
constexpr double kNear = 0.08;
constexpr std::size_t kFewPoints = 400;

}  // namespace

GlobalMatcher::GlobalMatcher(const OccupancyMap& map, const SurfelMap& surfels,
                             const MatcherConfig& config)
    : map_(map), surfels_(surfels), config_(config), revision_(map.revision()) {}

Match GlobalMatcher::match(const Cloud& cloud, double mode_ratio) {
  VOXLIST_CHECK(map_.revision() == revision_,
                "the map has changed and map_changed() was not called");
  const GlobalMap& map = map_for(reach_m(cloud.points));
  const auto scan =
      map.choose_points(cloud.points, static_cast<std::size_t>(config_.search_points));
  if (scan.size() < kFewestMatchPoints) return {};
  SearchConfig config{.max_nodes = config_.max_nodes};
  config.mode_ratio = mode_ratio;
  config.max_modes = kModes;
  config.mode_distance_m = 0.25;
  config.mode_turn_rad = 0.1;
  SearchResult found = global_search(map, scan, config);
  Match match;
  match.certified = found.certified;
  match.complete = found.complete;
  match.unseen = found.complete ? mode_ratio : 1.0;
  match.poses_examined = found.poses_examined;
  if (found.modes.empty()) return match;
  for (OverlapMode& mode : found.modes) mode.pose = middle_of_peak(map.tolerant(), scan, mode.pose);
  const MatchPoints points = choose_match_points(
      cloud,
      {.max_range_m = config_.max_range_m, .spacing_m = 0.1, .max_points = config_.refine_points});
  const auto rays = choose_evidence_rays(cloud);
  if (!evidence_) evidence_.emplace(map_);
  // Most of the way with few points, the best ones the rest.
  match.modes = refined(surfels_, some_of(points, kFewPoints), candidates_of(found, scan.size()));
  weigh(*evidence_, rays, match);
  std::size_t kept = 0;
  while (kept < match.modes.size() &&
         (kept < kBestModes || match.modes[kept].support > match.modes.front().support - kNear))
    ++kept;
  match.modes.resize(kept);
  match.modes = refined(surfels_, points, match.modes);
  weigh(*evidence_, rays, match);
  const TolerantMap& cells = map.tolerant();
  match.significance_log10 = log10_significance(
      std::int64_t{cells.size_x()} * cells.size_y() * cells.size_z(), cells.occupied_cells(),
      scan.size(), found.modes.front().overlap, found.lattice_poses);
  return match;
}

void GlobalMatcher::map_changed() {
  revision_ = map_.revision();
  maps_.clear();
  evidence_.reset();
  closed_cell_m_.reset();
}

// How far most of the scan reaches, in few steps: the map is made ready for each, and the lattice
// depends on it. The farthest points would ask for finer angles than they repay.
double GlobalMatcher::reach_m(std::span<const Eigen::Vector3f> points) const {
  constexpr double kMost = 0.9, kShortest_m = 12.0;
  double reach_m = kShortest_m;
  const auto within = [&](const Eigen::Vector3f& p) {
    return p.head<2>().cast<double>().squaredNorm() <= reach_m * reach_m;
  };
  const double enough = kMost * static_cast<double>(points.size());
  while (reach_m < config_.max_range_m &&
         static_cast<double>(std::count_if(points.begin(), points.end(), within)) < enough)
    reach_m *= 2.0;
  return std::min(reach_m, config_.max_range_m);
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
