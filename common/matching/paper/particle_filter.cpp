#include "voxlist/matching/paper/particle_filter.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>
#include <utility>

namespace voxlist::matching {
namespace {

// Algorithm 2 on a map.
VoxelMap down_sampled(const VoxelMap& map, std::int32_t factor) {
  VoxelMap coarse(map.resolution_m() * factor);
  map.for_each_voxel([&](const Voxel& v) {
    coarse.insert({floor_div(v.x, factor), floor_div(v.y, factor), floor_div(v.z, factor)});
  });
  return coarse;
}

std::vector<Particle> best_first(ParticleSet particles, const PoseLattice& lattice) {
  std::stable_sort(particles.begin(), particles.end(),
                   [](const auto& a, const auto& b) { return a.weight > b.weight; });
  std::vector<Particle> result;
  result.reserve(particles.size());
  for (const WeightedKey& p : particles) result.push_back({pose_at(lattice, p.key), p.weight});
  return result;
}

}  // namespace

ParticleFilter::ParticleFilter(const VoxelMap& map, const ParticleFilterConfig& config)
    : config_(config) {
  const auto power_of_two = [](int factor) {
    return factor >= 1 && std::has_single_bit(static_cast<unsigned>(factor));
  };
  if (!power_of_two(config.coarsest_factor) || !power_of_two(config.final_factor) ||
      config.final_factor > config.coarsest_factor || config.max_particles < kChildren) {
    throw std::invalid_argument(fmt::format("ParticleFilter: factors {} to {}, max_particles {}",
                                            config.coarsest_factor, config.final_factor,
                                            config.max_particles));
  }
  maps_.push_back(down_sampled(map, config.final_factor));
  for (int f = config.final_factor; f < config.coarsest_factor; f *= 2)
    maps_.push_back(down_sampled(maps_.back(), 2));
  std::reverse(maps_.begin(), maps_.end());
}

ParticleFilterResult ParticleFilter::localise(std::span<const Eigen::Vector3f> points_base,
                                              const PoseWindow& window) const {
  ParticleFilterResult result;
  PoseLattice lattice(maps_.front().resolution_m(), horizontal_radius_m(points_base));
  if (count_uniform_poses(lattice, window) > static_cast<double>(config_.max_particles)) {
    result.truncated = true;
    return result;
  }
  ParticleSet particles = uniform_poses(lattice, window);
  for (std::size_t level = 0; level < maps_.size(); ++level) {
    if (level > 0) {
      result.truncated |= keep_heaviest(particles, config_.max_particles / kChildren);
      lattice = lattice.finer();
      particles = resample(particles, lattice);
    }
    const std::size_t weighed = particles.size();
    const Weighing weighing = update_weights(particles, lattice, maps_[level], points_base);
    prune(particles, config_.prune_share, weighing.max_weight);
    result.levels.push_back({lattice.resolution_m(), weighed, particles.size(), weighing});
  }
  result.particles = best_first(std::move(particles), lattice);
  return result;
}

}  // namespace voxlist::matching
