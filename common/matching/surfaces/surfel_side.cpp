#include "voxlist/matching/surfaces/surfel_side.h"

#include <array>

#include "voxlist/voxels/fast_cell.h"

namespace voxlist::matching {
namespace {

// Rays are looked for from this far off a surface (m), three voxels: nearer ones may be noise of
// the surface itself. With 0.02, up to 5 % of the scans of a changed floor are not found
// (bench_tracking 40 1).
constexpr double kFirst_m = 0.06;
// From there on rays are looked for in so many steps (m), to 0.16 m: about the thickness of a wall
// and two cells of what rays passed. Farther, the rays of the next room would count.
constexpr double kStep_m = 0.02;
constexpr int kSteps = 6;
// Voxels of a surfel from which its sides are looked at: each takes time, and cells of 0.08 m that
// rays passed are as large as a quarter of a surfel's edge. A judgement.
constexpr std::size_t kSamples = 8;

// Looks voxels up that lie near each other, mostly in a block that was asked for before: of the
// blocks whose coordinates are even and odd alike, the last one is remembered.
class NearbyLookUp {
 public:
  explicit NearbyLookUp(const VoxelMap& map) : map_(map), per_m_(1.0 / map.resolution_m()) {}

  bool contains(const Eigen::Vector3d& p) {
    const Voxel v = cell_at(p, per_m_), at = block_of(v);
    Known& known = known_[static_cast<std::size_t>((at.x & 1) | (at.y & 1) << 1 | (at.z & 1) << 2)];
    if (!known.block || known.at != at) known = {at, find(at)};
    return ((*known.block)[static_cast<std::size_t>(v.z & 7)] >> ((v.x & 7) + 8 * (v.y & 7)) & 1) !=
           0;
  }

 private:
  struct Known {
    Voxel at;
    const VoxelBlock* block = nullptr;
  };

  const VoxelBlock* find(const Voxel& at) const {
    static constexpr VoxelBlock kNothing{};
    const VoxelBlock* block = map_.find_block(at);
    return block ? block : &kNothing;
  }

  const VoxelMap& map_;
  const double per_m_;
  std::array<Known, 8> known_;
};

// In how many steps from a point on a surface rays passed, before something else is met: the other
// face of a thin wall, past which there is another room.
int free_steps(NearbyLookUp& occupied, NearbyLookUp& passed, const Eigen::Vector3d& from,
               const Eigen::Vector3d& direction) {
  int free = 0;
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Vector3d p = from + (kFirst_m + i * kStep_m) * direction;
    if (occupied.contains(p)) break;
    free += passed.contains(p);
  }
  return free;
}

}  // namespace

void find_side(const OccupancyMap& map, std::span<const Voxel> voxels, const Voxel& lowest,
               Surfel& surfel) {
  if (map.passed.empty()) return;
  const std::size_t samples = std::min(kSamples, voxels.size());
  NearbyLookUp occupied(map.occupied), passed(map.passed);
  int balance = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    const Voxel& v = voxels[i * voxels.size() / samples];
    const Eigen::Vector3d p =
        center({lowest.x + v.x, lowest.y + v.y, lowest.z + v.z}, map.occupied.resolution_m());
    const Eigen::Vector3d foot = p - surfel.normal * surfel.normal.dot(p - surfel.mean);
    balance += free_steps(occupied, passed, foot, surfel.normal);
    balance -= free_steps(occupied, passed, foot, -surfel.normal);
  }
  if (balance < 0) surfel.normal = -surfel.normal;
  // Less than one step a sample tells no side.
  surfel.two_sided = static_cast<std::size_t>(std::abs(balance)) < samples;
}

}  // namespace voxlist::matching
