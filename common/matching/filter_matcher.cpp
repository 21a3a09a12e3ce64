#include "matching/filter_matcher.h"

#include <algorithm>
#include <cmath>

#include "matching/match_modes.h"
#include "matching/particle_filter.h"

namespace voxlist {
namespace {

class ParticleFilterMatcher : public Matcher {
 public:
  ParticleFilterMatcher(const OccupancyMap& map, const MatcherConfig& config)
      : config_(config),
        filter_(map.occupied, {.final_factor = final_factor(map.occupied, config)}),
        box_(map.occupied, {.resolution_m = config.resolution_m, .levels = 0}),
        surfels_(map),
        evidence_(map) {}

  Match match(const Cloud& cloud, const std::optional<PoseWindow>& window) override {
    const MatchPoints scan = chosen_points(cloud.points, config_, 0.05, config_.refine_points);
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
    match.modes = refined(surfels_, scan.points, candidates);
    weigh(evidence_, choose_evidence_rays(cloud), match);
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
  const EvidenceMap evidence_;
};

}  // namespace

std::unique_ptr<Matcher> make_filter_matcher(const OccupancyMap& map, const MatcherConfig& config) {
  return std::make_unique<ParticleFilterMatcher>(map, config);
}

}  // namespace voxlist
