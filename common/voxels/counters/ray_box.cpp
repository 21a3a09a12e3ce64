#include "voxlist/voxels/counters/ray_box.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "voxlist/voxels/voxel_map.h"

namespace voxlist {
namespace {

std::int32_t cell_of(std::int32_t fractions) { return fractions >> kFractionBits; }
std::int32_t block_of(std::int32_t fractions) { return cell_of(fractions) / kBlockEdge; }

// Bits of the numbers of blocks along each axis: what is needed, while there is room for it.
void share_bits(int bits[3]) {
  for (int i = 0; i < 3; ++i) bits[i] = std::min(bits[i], kBoxBits - 3);
  while (bits[0] + bits[1] + bits[2] > kMostBlockBits) --*std::max_element(bits, bits + 3);
}

}  // namespace

RayBox::RayBox(const std::int32_t lowest[3], const std::int32_t highest[3],
               const std::int32_t start[3]) {
  for (int i = 0; i < 3; ++i)
    bits_[i] =
        std::bit_width(static_cast<std::uint32_t>(block_of(highest[i]) - block_of(lowest[i])));
  share_bits(bits_);
  for (int i = 0, shift = kBlockKeyBits; i < 3; shift += bits_[i++]) {
    const std::int32_t blocks = 1 << bits_[i];
    corner_[i] = block_of(lowest[i]) * kBlockEdge;
    block_shift_[i] = shift;
    if (block_of(highest[i]) - block_of(lowest[i]) < blocks) continue;
    corner_[i] = std::max(block_of(start[i]) - blocks / 2, 0) * kBlockEdge;
    is_about_all_ = false;
  }
}

bool RayBox::holds(const std::int32_t end[3]) const {
  for (int i = 0; i < 3; ++i) {
    const std::int32_t cell = cell_of(end[i]) - corner_[i];
    if (cell < 0 || cell >= kBlockEdge << bits_[i]) return false;
  }
  return true;
}

double RayBox::cut(FixedRay& ray) const {
  double share = 1.0;
  for (int i = 0; i < 3; ++i) {
    const double lowest = std::ldexp(corner_[i], kFractionBits);
    const double highest = lowest + std::ldexp(kBlockEdge << bits_[i], kFractionBits) - 1.0;
    const double way = static_cast<double>(ray.to[i]) - ray.from[i];
    const double room = (way > 0.0 ? highest : lowest) - ray.from[i];
    if (room / way < share) share = std::max(room / way, 0.0);
  }
  ray = part_of(ray, share);
  return share;
}

Voxel RayBox::block(std::uint32_t number) const {
  const auto along = [&](int i) {
    const std::uint32_t mask = (1u << bits_[i]) - 1;
    const auto inside =
        static_cast<std::int32_t>(number >> (block_shift_[i] - kBlockKeyBits) & mask);
    return (corner_[i] - kReach) / kBlockEdge + inside;
  };
  return {along(0), along(1), along(2)};
}

FixedRay part_of(const FixedRay& ray, double share) {
  FixedRay part = ray;
  for (int i = 0; i < 3; ++i) {
    const double way = static_cast<double>(ray.to[i]) - ray.from[i];
    part.to[i] = ray.from[i] + static_cast<std::int32_t>(way * share);
  }
  return part;
}

double length_of(const FixedRay& ray) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double way = static_cast<double>(ray.to[i]) - ray.from[i];
    sum += way * way;
  }
  return std::sqrt(sum);
}

}  // namespace voxlist
