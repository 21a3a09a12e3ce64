#include "matching/matcher.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "matching/particle_filter.h"
#include "matching/significance.h"
#include "matching/surfels.h"

namespace voxlist {
namespace {

// Two refined poses nearer than this are one mode: about the reach of the refinement.
constexpr double kSameMode_m = 0.2;
constexpr double kSameMode_rad = 0.07;

MatchPoints chosen(std::span<const Eigen::Vector3f> points, const MatcherConfig& config,
                   double spacing_m, int most) {
  return choose_match_points(
      points, {.max_range_m = config.max_range_m, .spacing_m = spacing_m, .max_points = most});
}

double log10_significance(const Pyramid& pyramid, std::size_t points, int overlap, double poses) {
  const Voxel size{pyramid.end().x - pyramid.lowest().x, pyramid.end().y - pyramid.lowest().y,
                   pyramid.end().z - pyramid.lowest().z};
  const std::int64_t volume = std::int64_t{size.x} * size.y * size.z;
  const ChanceModel model{volume, std::min(pyramid.occupied_cells(), volume),
                          std::min(static_cast<std::int64_t>(points), volume)};
  return log10_best_of(log10_overlap_tail(model, overlap), std::max(1.0, poses));
}

MatchMode candidate(const Pose2& pose, double overlap) {
  MatchMode mode;
  mode.pose = pose;
  mode.overlap = overlap;
  return mode;
}

bool same_mode(const MatchMode& mode, const Pose2& pose) {
  return distance_m(mode.pose, pose) < kSameMode_m && turn_rad(mode.pose, pose) < kSameMode_rad;
}

bool holds(const std::vector<MatchMode>& modes, const Pose2& pose) {
  return std::any_of(modes.begin(), modes.end(),
                     [&](const MatchMode& mode) { return same_mode(mode, pose); });
}

// Refines candidates and keeps the distinct ones, best fit first.
std::vector<MatchMode> refined(const SurfelMap& surfels, std::span<const Eigen::Vector3f> points,
                               std::vector<MatchMode> candidates) {
  for (MatchMode& mode : candidates) {
    const Refinement refinement = refine(surfels, points, mode.pose);
    mode.pose = refinement.pose;
    mode.covariance = refinement.covariance;
    mode.fit = refinement.inlier_share;
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.fit > b.fit; });
  std::vector<MatchMode> modes;
  for (const MatchMode& mode : candidates) {
    if (!holds(modes, mode.pose)) modes.push_back(mode);
  }
  return modes;
}

class SearchMatcher : public Matcher {
 public:
  SearchMatcher(const VoxelMap& map, const MatcherConfig& config)
      : config_(config), map_(map), surfels_(map) {}

  Match match(std::span<const Eigen::Vector3f> points,
              const std::optional<PoseWindow>& window) override {
    const MatchPoints scan = chosen(points, config_, 0.2, config_.search_points);
    if (scan.points.size() < kFewestMatchPoints) return {};
    const SearchMap& map = search_map(window.has_value());
    const SearchResult found =
        search(map, scan, window.value_or(whole_map(map)), search_config(window.has_value()));
    Match match;
    match.certified = found.certified;
    match.complete = found.complete;
    match.poses_examined = found.poses_examined;
    if (found.modes.empty()) return match;
    std::vector<MatchMode> candidates;
    for (const OverlapMode& mode : found.modes) {
      const double share =
          static_cast<double>(mode.overlap) / static_cast<double>(scan.points.size());
      candidates.push_back(candidate(mode.pose, share));
    }
    const MatchPoints fine = chosen(points, config_, 0.1, config_.refine_points);
    match.modes = refined(surfels_, fine.points, std::move(candidates));
    match.significance_log10 = log10_significance(map.pyramid(), scan.points.size(),
                                                  found.modes.front().overlap, found.lattice_poses);
    return match;
  }

 private:
  const SearchMap& search_map(bool windowed) {
    auto& map = windowed ? window_map_ : whole_map_;
    if (!map)
      map.emplace(map_, PyramidConfig{.resolution_m = windowed ? config_.window_resolution_m
                                                               : config_.resolution_m,
                                      .levels = windowed ? 3 : 4});
    return *map;
  }

  // Within a window slips of less than a step of the robot matter; in a whole map other rooms do.
  SearchConfig search_config(bool windowed) const {
    SearchConfig search{.max_nodes = config_.max_nodes};
    if (windowed) {
      search.mode_ratio = 0.9;
      search.mode_distance_m = 0.3;
      search.mode_turn_rad = 0.1;
    }
    return search;
  }

  const MatcherConfig config_;
  const VoxelMap& map_;
  const SurfelMap surfels_;
  std::optional<SearchMap> whole_map_, window_map_;
};

class ParticleFilterMatcher : public Matcher {
 public:
  ParticleFilterMatcher(const VoxelMap& map, const MatcherConfig& config)
      : config_(config),
        filter_(map, {.final_factor = final_factor(map, config)}),
        box_(map, {.resolution_m = config.resolution_m, .levels = 0}),
        surfels_(map) {}

  Match match(std::span<const Eigen::Vector3f> points,
              const std::optional<PoseWindow>& window) override {
    const MatchPoints scan = chosen(points, config_, 0.05, config_.refine_points);
    if (scan.points.size() < kFewestMatchPoints) return {};
    const auto found = filter_.localise(scan.points, window.value_or(whole_map(box_)));
    Match match;
    for (const auto& level : found.levels)
      match.poses_examined += static_cast<std::int64_t>(level.particles);
    if (found.particles.empty()) return match;
    match.complete = !found.truncated;
    const auto& last = found.levels.back();
    const double voxels =
        static_cast<double>(last.weighing.look_ups) / static_cast<double>(last.particles);
    std::vector<MatchMode> candidates;
    for (const Particle& particle : found.particles) {
      if (candidates.size() == SearchConfig().max_modes) break;
      if (!holds(candidates, particle.pose))
        candidates.push_back(candidate(particle.pose, particle.weight / voxels));
    }
    match.modes = refined(surfels_, scan.points, std::move(candidates));
    return match;
  }

 private:
  static int final_factor(const VoxelMap& map, const MatcherConfig& config) {
    const double factor = config.resolution_m / map.resolution_m();
    return 1 << std::clamp(static_cast<int>(std::lround(std::log2(factor))), 0, 6);
  }

  const MatcherConfig config_;
  const ParticleFilter filter_;
  const SearchMap box_;
  const SurfelMap surfels_;
};

}  // namespace

std::unique_ptr<Matcher> make_matcher(const VoxelMap& map, const MatcherConfig& config) {
  if (config.engine == "search") return std::make_unique<SearchMatcher>(map, config);
  if (config.engine == "particle_filter")
    return std::make_unique<ParticleFilterMatcher>(map, config);
  throw std::invalid_argument("engine = \"" + config.engine +
                              "\": must be search or particle_filter");
}

}  // namespace voxlist
