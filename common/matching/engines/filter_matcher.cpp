#include "voxlist/matching/engines/filter_matcher.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxlist/geometry/elementary.h"
#include "voxlist/matching/engines/global_matcher.h"
#include "voxlist/matching/engines/match_modes.h"
#include "voxlist/matching/paper/particle_filter.h"

namespace voxlist::matching {
namespace {

// Most particles that are refined, distinct in pose. One refinement takes about 1 ms, the filter
// seconds.
constexpr std::size_t kMostModes = 8;

// A filter cannot tell what it has lost. That it has lost no mode that a complete search would list
// is taken for granted, and nowhere proven.
constexpr double kUnseen = kModeRatio;

// The filter ends at voxels of the map's edge, doubled at most this often: 2^6 x 0.02 m is 1.28 m,
// the paper's coarsest level.
constexpr int kMostDoublings = 6;

int final_factor(const VoxelMap& map, const MatcherConfig& config) {
  const double factor = config.resolution_m / map.resolution_m();
  return 1 << std::clamp(static_cast<int>(std::lround(elementary::log(factor) / std::numbers::ln2)),
                         0, kMostDoublings);
}

std::int64_t poses_examined(const ParticleFilterResult& found) {
  std::int64_t poses = 0;
  for (const ParticleFilterLevel& level : found.levels)
    poses += static_cast<std::int64_t>(level.particles);
  return poses;
}

// The best particles that are distinct in pose.
std::vector<MatchMode> candidates_of(const ParticleFilterResult& found) {
  const ParticleFilterLevel& last = found.levels.back();
  const double voxels =
      static_cast<double>(last.weighing.look_ups) / static_cast<double>(last.particles);
  std::vector<MatchMode> candidates;
  for (const Particle& particle : found.particles) {
    if (candidates.size() == kMostModes) break;
    if (!holds(candidates, particle.pose))
      candidates.push_back(candidate(particle.pose, particle.weight / voxels));
  }
  return candidates;
}

class ParticleFilterMatcher : public Matcher {
 public:
  ParticleFilterMatcher(const OccupancyMap& map, const MatcherConfig& config)
      : map_(map), config_(config) {}

  Match match(const PreparedScan& scan, const std::optional<PoseWindow>& window) override {
    const MatchPoints& points = scan.points();
    if (points.points.size() < kFewestMatchPoints) return {};
    const auto found =
        ready().filter.localise(scan.filter_points(), window.value_or(whole_map(map_.occupied)));
    Match match;
    match.poses_examined = poses_examined(found);
    if (found.particles.empty()) return match;
    match.complete = !found.truncated;
    match.unseen = match.complete ? kUnseen : 1.0;
    match.modes = refined(ready().surfels, points, candidates_of(found));
    rank(ready().evidence, scan.few_rays(), match.modes);
    return match;
  }

  Match track(const PreparedScan& scan, const std::optional<PoseWindow>& window,
              const UncertainPose&) override {
    Match found = match(scan, window);
    weigh_on_surfaces(ready().evidence, ready().surfels, scan.few_rays(), found.modes);
    return found;
  }

  Eigen::Matrix3d covariance_without_lines(const PreparedScan&, const MatchMode& mode,
                                           const UncertainPose&) override {
    return mode.covariance;
  }

  SpatialRefinement refined_in_space(const MatchPoints& points, const Pose3& start) override {
    return refine(ready().surfels, points, start);
  }

  Evidence evidence_on_surfaces(const Pose2& pose, std::span<const ScanRay> rays) override {
    return ready().evidence.on_surfaces(pose, rays, ready().surfels);
  }

  const EvidenceMap& evidence() override { return ready().evidence; }

  void map_changed(const ChangedBlocks&) override { ready_.reset(); }

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

  const OccupancyMap& map_;
  const MatcherConfig config_;
  std::unique_ptr<Ready> ready_;
};

}  // namespace

std::unique_ptr<Matcher> make_filter_matcher(const OccupancyMap& map, const MatcherConfig& config) {
  return std::make_unique<ParticleFilterMatcher>(map, config);
}

}  // namespace voxlist::matching
