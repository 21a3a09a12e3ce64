#pragma once

#include <Eigen/Core>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "voxlist/geometry/pose.h"
#include "voxlist/matching/search/pose_window.h"
#include "voxlist/voxels/voxel_map.h"

// The steps of the paper's particle filter (section III); particle_filter.h puts them together.

namespace voxlist::matching {

/// The poses of one level: positions by its resolution, headings by equation 1.
class PoseLattice {
 public:
  /// radius_m is R, the largest horizontal range of the scan's points. Preconditions: radius_m >=
  /// 0, resolution_m > 0.
  PoseLattice(double resolution_m, double radius_m);

  /// The level below: half the resolution, twice the headings. Pose (ix, iy, itheta) of this level
  /// is (2 ix, 2 iy, 2 itheta) there.
  PoseLattice finer() const;

  double resolution_m() const { return resolution_m_; }
  std::int32_t headings() const { return headings_; }
  double heading_step_rad() const;

 private:
  double resolution_m_;
  std::int32_t headings_;
};

/// R of equation 1: the largest horizontal range (m) of the points, without those that no map
/// accepts; 0 when there are none.
double horizontal_radius_m(std::span<const Eigen::Vector3f> points_base);

/// One pose of a lattice: x = ix resolution, y = iy resolution, yaw = itheta heading steps.
/// 0 <= itheta < headings.
struct PoseKey {
  // Heading first: in this order each heading's particles are neighbours and the scan is turned
  // once for all of them.
  std::int32_t itheta = 0;
  std::int32_t ix = 0;
  std::int32_t iy = 0;

  auto operator<=>(const PoseKey&) const = default;
};

/// The pose (T_map_base) that a key stands for.
Pose2 pose_at(const PoseLattice& lattice, const PoseKey& key);

/// A pose and its weight: the overlap of the scan there, not normalised.
struct WeightedKey {
  PoseKey key;
  int weight = 0;
};

/// Unique poses in the order of their keys (the paper's tree set).
using ParticleSet = std::vector<WeightedKey>;

/// How many poses uniform_poses makes; needs no memory.
double count_uniform_poses(const PoseLattice& lattice, const PoseWindow& window);

/// All poses of the lattice in a window: each pose of the window is within half a step of one of
/// them. The window is cut at the map's lattice (kVoxelLimit). Throws std::invalid_argument on a
/// window that is not finite or has a half width below 0.
ParticleSet uniform_poses(const PoseLattice& lattice, const PoseWindow& window);

/// What Algorithm 3 did.
struct Weighing {
  int max_weight = 0;         ///< w_max
  std::size_t rotations = 0;  ///< how often the scan was turned: once for each heading of the set
  std::int64_t look_ups = 0;  ///< voxels that were looked up in the map
};

/// Sets each particle's weight to its overlap (Algorithm 3). `map` has the lattice's resolution;
/// points in base (m).
Weighing update_weights(ParticleSet& particles, const PoseLattice& lattice, const VoxelMap& map,
                        std::span<const Eigen::Vector3f> points_base);

/// Removes the particles whose weight is below `share` of max_weight, and those without any
/// overlap.
void prune(ParticleSet& particles, double share, int max_weight);

/// Removes the lightest (on ties the later) particles until no more than `count` are left. True
/// when some were removed.
bool keep_heaviest(ParticleSet& particles, std::size_t count);

/// Poses around one that re-sampling makes.
inline constexpr std::size_t kChildren = 27;

/// The poses of the finer lattice up to one step from each particle in x, y and heading, each once
/// (Algorithm 4). Weights are 0.
ParticleSet resample(const ParticleSet& particles, const PoseLattice& finer);

}  // namespace voxlist::matching
