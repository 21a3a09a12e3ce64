#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "voxlist/matching/paper/particle_filter.h"

namespace voxlist::desk {

/// The paper's filter after one of its levels.
struct TraceLevel {
  matching::PoseLattice lattice;
  std::size_t weighed = 0;
  matching::Weighing weighing;
  matching::ParticleSet kept;  ///< those of at least 80 % of the best
  Pose2 best;
  double seconds = 0.0;  ///< CPU time of weighing, pruning and re-sampling
};

/// Algorithm 1 step by step, as ParticleFilter::localise does it: what each level did, coarsest
/// first. Of the filter's default settings.
std::vector<TraceLevel> trace(const matching::ParticleFilter& filter,
                              std::span<const Eigen::Vector3f> points_base,
                              const matching::PoseWindow& window);

/// CPU time of this thread (s).
double thread_seconds();

}  // namespace voxlist::desk
