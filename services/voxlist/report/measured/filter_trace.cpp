#include "services/voxlist/report/measured/filter_trace.h"

#include <time.h>

#include <algorithm>

namespace voxlist::desk {
namespace {

constexpr matching::ParticleFilterConfig kConfig;

// Of equal weights the one that comes first, as in ParticleFilterResult.
Pose2 best_of(const matching::ParticleSet& kept, const matching::PoseLattice& lattice) {
  const auto best = std::ranges::max_element(kept, {}, &matching::WeightedKey::weight);
  return best == kept.end() ? Pose2{} : matching::pose_at(lattice, best->key);
}

}  // namespace

std::vector<TraceLevel> trace(const matching::ParticleFilter& filter,
                              std::span<const Eigen::Vector3f> points_base,
                              const matching::PoseWindow& window) {
  const auto& maps = filter.maps();
  matching::PoseLattice lattice(maps.front().resolution_m(),
                                matching::horizontal_radius_m(points_base));
  std::vector<TraceLevel> levels;
  for (const VoxelMap& map : maps) {
    const double start = thread_seconds();
    matching::ParticleSet particles;
    if (levels.empty()) {
      particles = matching::uniform_poses(lattice, window);
    } else {
      particles = levels.back().kept;
      matching::keep_heaviest(particles, kConfig.max_particles / matching::kChildren);
      lattice = lattice.finer();
      particles = matching::resample(particles, lattice);
    }
    const std::size_t weighed = particles.size();
    const matching::Weighing weighing =
        matching::update_weights(particles, lattice, map, points_base);
    matching::prune(particles, kConfig.prune_share, weighing.max_weight);
    const Pose2 best = best_of(particles, lattice);
    levels.push_back(
        {lattice, weighed, weighing, std::move(particles), best, thread_seconds() - start});
  }
  return levels;
}

double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

}  // namespace voxlist::desk
