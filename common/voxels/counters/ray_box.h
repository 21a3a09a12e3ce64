#pragma once

#include <cstdint>

#include "voxlist/voxels/counters/point_job.h"
#include "voxlist/voxels/voxel.h"

namespace voxlist {

/// Blocks of a box at most; each may take 4 bytes in a scratch.
inline constexpr int kMostBlockBits = 25;

/// A box of whole blocks about the rays of a scan, at most 2^kBoxBits cells along each side and
/// 2^kMostBlockBits blocks in all: 82 x 41 x 41 m at 0.02 m. Rays are told in fractions of a cell:
/// outside from (-kReach, -kReach, -kReach) on, inside from the box's corner on.
class RayBox {
 public:
  RayBox() = default;

  /// From the lowest to the highest ends; along an axis on which they lie too far apart about a
  /// start.
  RayBox(const std::int32_t lowest[3], const std::int32_t highest[3], const std::int32_t start[3]);

  /// Whether all ends are in the box.
  bool is_about_all() const { return is_about_all_; }

  bool holds(const std::int32_t end[3]) const;

  /// Cuts off what of a ray is outside; its start must be inside. Returns the share that is left.
  double cut(FixedRay& ray) const;

  /// Bits of the number of a block in the box.
  int block_bits() const { return bits_[0] + bits_[1] + bits_[2]; }
  const int* block_shift() const { return block_shift_; }

  /// The box's corner, in fractions from (-kReach, -kReach, -kReach) on.
  std::int32_t corner(int axis) const { return corner_[axis] << kFractionBits; }

  /// The position in the map of a block of that number.
  Voxel block(std::uint32_t number) const;

 private:
  std::int32_t corner_[3] = {};             // in cells from -kReach on
  int bits_[3] = {}, block_shift_[3] = {};  // of blocks
  bool is_about_all_ = true;
};

/// The first part of a ray.
FixedRay part_of(const FixedRay& ray, double share);

/// A ray's length, in fractions of a cell.
double length_of(const FixedRay& ray);

}  // namespace voxlist
