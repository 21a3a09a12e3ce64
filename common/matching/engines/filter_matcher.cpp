#include "voxlist/matching/engines/filter_matcher.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxlist/geometry/elementary.h"
#include "voxlist/matching/engines/match_modes.h"
#include "voxlist/matching/paper/particle_filter.h"

namespace voxlist::matching {
namespace {

class ParticleFilterMatcher : public Matcher {
 public:
  ParticleFilterMatcher(const OccupancyMap& map, const MatcherConfig& config)
      : map_(map), config_(config) {}

  Match match(const Cloud& cloud, const std::optional<PoseWindow>& window) override {
    const MatchPoints scan = choose_match_points(cloud, {.max_range_m = config_.max_range_m,
                                                         .spacing_m = 0.05,
                                                         .max_points = config_.refine_points});
    if (scan.points.size() < kFewestMatchPoints) return {};
    const auto found =
        ready().filter.localise(scan.points, window.value_or(whole_map(map_.occupied)));
    Match match;
    for (const auto& level : found.levels)
      match.poses_examined += static_cast<std::int64_t>(level.particles);
    if (found.particles.empty()) return match;
    match.complete = !found.truncated;
    // Taken for granted: a filter cannot tell what it has lost.
    match.unseen = match.complete ? 0.88 : 1.0;
    const auto& last = found.levels.back();
    const double voxels =
        static_cast<double>(last.weighing.look_ups) / static_cast<double>(last.particles);
    std::vector<MatchMode> candidates;
    for (const Particle& particle : found.particles) {
      if (candidates.size() == SearchConfig().max_modes) break;
      if (!holds(candidates, particle.pose))
        candidates.push_back(candidate(particle.pose, particle.weight / voxels));
    }
    match.modes = refined(ready().surfels, scan, candidates);
    weigh(ready().evidence, choose_evidence_rays(cloud), match);
    return match;
  }

  void map_grew(const ChangedBlocks&) override { ready_.reset(); }

 private:
  // What is made of the map.
  struct Ready {
    ParticleFilter filter;
    SurfelMap surfels;
    EvidenceMap evidence;
  };

  Ready& ready() {
    if (!ready_) {
      ready_.reset(new Ready{
          ParticleFilter(map_.occupied, {.final_factor = final_factor(map_.occupied, config_)}),
          SurfelMap(map_), EvidenceMap(map_)});
    }
    return *ready_;
  }

  static int final_factor(const VoxelMap& map, const MatcherConfig& config) {
    const double factor = config.resolution_m / map.resolution_m();
    return 1 << std::clamp(
               static_cast<int>(std::lround(elementary::log(factor) / std::numbers::ln2)), 0, 6);
  }

  const OccupancyMap& map_;
  const MatcherConfig config_;
  std::unique_ptr<Ready> ready_;
};

}  // namespace

std::unique_ptr<Matcher> make_filter_matcher(const OccupancyMap& map, const MatcherConfig& config) {
  return std::make_unique<ParticleFilterMatcher>(map, config);
}

}  // namespace voxlist::matching
