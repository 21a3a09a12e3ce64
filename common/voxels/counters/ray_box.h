#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/voxels/counters/ray_job.h"
#include "voxlist/voxels/voxel.h"

namespace voxlist {

/// Cells from the map's origin along each axis that rays may reach: 655 m at 0.02 m. As many as an
/// OctoMap has.
inline constexpr std::int32_t kReach = 1 << 15;

/// Blocks of a box at most; each may take 4 bytes in a scratch.
inline constexpr int kMostBlockBits = 25;

/// A box of whole blocks about the rays of a scan, at most 2^kBoxBits cells along each side and
/// 2^kMostBlockBits blocks in all: 82 x 41 x 41 m at 0.02 m. Rays are told in fractions of a cell:
/// outside from (-kReach, -kReach, -kReach) on, inside from the box's corner on.
class RayBox {
 public:
  /// About all ends; along an axis on which they lie too far apart about the first ray's start.
  static RayBox about(const std::vector<FixedRay>& rays);

  /// Whether all ends are in the box.
  bool is_about_all() const { return is_about_all_; }

  bool holds(const std::int32_t end[3]) const;

  /// Moves a ray inside; both ends must be there.
  void move_inside(FixedRay& ray) const;

  /// Cuts off what of a ray is outside; its start must be inside. Returns the share that is left.
  double cut(FixedRay& ray) const;

  /// Bits of the number of a block in the box.
  int block_bits() const { return bits_[0] + bits_[1] + bits_[2]; }
  const int* block_shift() const { return block_shift_; }

  /// The key of the cell that holds a place in the box.
  std::uint64_t key_at(const std::int32_t place[3]) const {
    std::uint64_t key = 0;
    for (int i = 0; i < 3; ++i) {
      const auto cell = static_cast<std::uint64_t>(place[i] >> kFractionBits);
      key |= key_part(cell, i, block_shift_[i]);
    }
    return key;
  }

  /// The position in the map of a block of that number.
  Voxel block(std::uint32_t number) const;

 private:
  void lay(const std::int32_t lowest[3], const std::int32_t highest[3],
           const std::int32_t start[3]);

  std::int32_t corner_[3] = {};             // in cells from -kReach on
  int bits_[3] = {}, block_shift_[3] = {};  // of blocks
  bool is_about_all_ = true;
};

/// The first part of a ray.
FixedRay part_of(const FixedRay& ray, double share);

/// A ray's length, in fractions of a cell.
double length_of(const FixedRay& ray);

}  // namespace voxlist
