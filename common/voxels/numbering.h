#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "voxlist/voxels/voxel.h"

namespace voxlist {

/// A cell as one number, ascending by layer, row and column. Coordinates within +-2^20: 52 km at
/// 0.05 m.
inline std::uint64_t key_of(const Voxel& v) {
  const auto part = [](std::int32_t value) {
    return static_cast<std::uint64_t>(value + (1 << 20)) & 0x1fffff;
  };
  return part(v.z) << 42 | part(v.y) << 21 | part(v.x);
}

/// The layer of a key's cell: ascending, the same for cells of the same height.
inline std::uint64_t layer_of(std::uint64_t key) { return key >> 42; }

/// Numbers different keys 0, 1, 2, ... in the order in which they are met.
class Numbering {
 public:
  /// Room for `most` different keys.
  explicit Numbering(std::size_t most) {
    std::size_t size = 64;
    while (size < 2 * most) size *= 2;
    slots_.resize(size);
  }

  /// The number of a key.
  std::uint32_t number(std::uint64_t key) {
    const std::size_t mask = slots_.size() - 1;
    const std::uint64_t hash = key * 0x9e3779b97f4a7c15u;
    std::size_t slot = (hash ^ (hash >> 32)) & mask;
    while (slots_[slot].number != 0 && slots_[slot].key != key) slot = (slot + 1) & mask;
    if (slots_[slot].number == 0) slots_[slot] = {key, ++count_};
    return slots_[slot].number - 1;
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t number = 0;
  };
  std::vector<Slot> slots_;
  std::uint32_t count_ = 0;
};

}  // namespace voxlist
