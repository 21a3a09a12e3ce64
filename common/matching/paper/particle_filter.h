#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "voxlist/geometry/pose.h"
#include "voxlist/matching/paper/particle_set.h"
#include "voxlist/voxels/voxel_map.h"

// The paper's multi-resolution particle filter (section III), step by step: Algorithm 1 is
// ParticleFilter::localise; Algorithm 3 is update_weights, Algorithm 4 resample, equation 1
// PoseLattice (all in particle_set.h), equation 2 overlap(). It is the reference of the faster
// search, not the engine of the localiser: pruning by coarse counts is a heuristic.
//
// Where the paper contradicts itself, this is what is done:
// - The first level is 2^6 x 0.02 = 1.28 m (the text says 1.24 m).
// - Poses are integers (ix, iy, itheta), so that equal poses are equal; the paper keeps sets of
// real
//   numbers.
// - 2 pi / dtheta is no integer: the circle is divided into the next larger number of steps, which
//   doubles from level to level so that angles nest, and itheta is taken modulo that number.
// - Re-sampling moves by one step of the new level in x, y and theta, as Algorithm 1 says (eps / 2,
//   dtheta / 2); Algorithm 4 turns by the whole old dtheta, with which angles would never get
//   finer.
// - Algorithm 3 compares with w_max but assigns another variable: here w_max is updated.
// - Pruning is relative to the largest weight ("mode" in Algorithm 1, "maximum weight" in the
// text).
// - Points are turned and then put into voxels, at every level; turned voxels would be quantised
//   twice.
// - Math.round biases down-sampling by half a voxel: the lattice of voxels/voxel.h nests without
//   bias.

namespace voxlist::matching {

struct ParticleFilterConfig {
  /// Particles below this share of the largest weight are removed, 0..1: the paper's 80 % (section
  /// III, Algorithm 1). Higher: faster, and the true pose is lost at a coarse level more often.
  double prune_share = 0.8;
  /// Voxels of the first and of the last level, in voxels of the map. Powers of two, final <=
  /// coarsest. With a 0.02 m map: 64 is 1.28 m; 4 is 0.08 m, where the paper itself found its best
  /// results.
  int coarsest_factor = 64;
  int final_factor = 1;
  /// Most particles that a level may start from, repeated ones counted: bounds memory at about 30
  /// bytes each.
  std::size_t max_particles = 2'000'000;
};

struct Particle {
  Pose2 pose;
  int weight = 0;
};

/// What one level of the filter did.
struct ParticleFilterLevel {
  double resolution_m = 0.0;
  std::size_t particles = 0;  ///< weighed
  std::size_t kept = 0;       ///< left after pruning
  Weighing weighing;
};

struct ParticleFilterResult {
  /// Those left at the last level, best first (ties by heading, x, y); empty when nothing of the
  /// scan overlaps.
  std::vector<Particle> particles;
  /// Coarsest first.
  std::vector<ParticleFilterLevel> levels;
  /// max_particles was hit: the lightest particles of a level were dropped, or, when the window
  /// alone holds too many poses, nothing was searched and `particles` is empty.
  bool truncated = false;
};

/// The filter on one map, which it copies, down-sampled, once for each level. Reading from several
/// threads is safe.
class ParticleFilter {
 public:
  /// Throws std::invalid_argument on a bad config.
  explicit ParticleFilter(const VoxelMap& map, const ParticleFilterConfig& config = {});

  /// Poses (T_map_base) of the window that the scan fits best (Algorithm 1). Global localisation
  /// and tracking differ in the window alone. The result depends on the set of points, not on their
  /// order. Points (m) that are not finite or beyond the map's lattice are ignored.
  ParticleFilterResult localise(std::span<const Eigen::Vector3f> points_base,
                                const PoseWindow& window) const;

  /// The map of each level, coarsest first.
  const std::vector<VoxelMap>& maps() const { return maps_; }

 private:
  ParticleFilterConfig config_;
  std::vector<VoxelMap> maps_;
};

}  // namespace voxlist::matching
