#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "voxlist/voxels/voxel.h"

namespace voxlist {

/// A cell as one number, ascending by layer, row and column. Different cells have different keys
/// when their coordinates are within +-2^20 (52 km at 0.05 m).
inline std::uint64_t key_of(const Voxel& v) {
  const auto part = [](std::int32_t value) {
    return std::uint64_t{static_cast<std::uint32_t>(value) + (1U << 20)} & 0x1fffff;
  };
  return part(v.z) << 42 | part(v.y) << 21 | part(v.x);
}

/// The layer of a key's cell: ascending, the same for cells of the same height.
inline std::uint64_t layer_of(std::uint64_t key) { return key >> 42; }

/// The key of the cell of twice the edge that holds a key's cell; its layers, too, are ascending.
inline std::uint64_t halved_key(std::uint64_t key) {
  constexpr std::uint64_t kPart = 0x1fffff;
  return (key >> 43) << 42 | ((key >> 21 & kPart) >> 1) << 21 | (key & kPart) >> 1;
}

/// The finaliser of splitmix64: every input bit reaches every output bit.
inline std::uint64_t mixed(std::uint64_t value) {
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9u;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebu;
  return value ^ (value >> 31);
}

inline std::uint64_t hash_of(std::uint64_t key) { return mixed(key); }
inline std::uint64_t hash_of(const Voxel& key) { return mixed(key_of(key)); }
inline std::uint64_t hash_of(const void* key) {
  return mixed(reinterpret_cast<std::uintptr_t>(key));
}

/// Numbers different keys 0, 1, 2, ... in the order in which they are met, so that what belongs to
/// a key stands in a vector at its number. This is the one hash table of the voxel code: blocks of
/// a map, cubes of its surfels, patches of its ground, cells of a scan. Open addressing, at most
/// half full: 8 to 16 bytes a key, and the key. Reading from several threads at once is safe.
template <class Key = std::uint64_t>
class Numbering {
 public:
  /// What find() gives for a key that was never met.
  static constexpr std::uint32_t kNone = 0xffffffff;

  /// `expected` keys fit without growing.
  explicit Numbering(std::size_t expected = 0) {
    std::size_t size = 64;
    while (size < 2 * expected) size *= 2;
    slots_.resize(size);
  }

  /// The number of a key. It equals the size() before when the key is met for the first time.
  std::uint32_t number(const Key& key) {
    std::size_t slot = slot_of(key);
    if (slots_[slot] == 0) {
      keys_.push_back(key);
      slots_[slot] = static_cast<std::uint32_t>(keys_.size());
      if (2 * keys_.size() > slots_.size()) {
        grow();
        return static_cast<std::uint32_t>(keys_.size()) - 1;
      }
    }
    return slots_[slot] - 1;
  }

  /// The number of a key that was met before, or kNone.
  std::uint32_t find(const Key& key) const { return slots_[slot_of(key)] - 1; }

  /// How many different keys were met, and the one that has a number.
  std::size_t size() const { return keys_.size(); }
  const Key& key(std::size_t number) const { return keys_[number]; }

  /// The keys in the order of their numbers.
  const std::vector<Key>& keys() const { return keys_; }

  /// Forgets all keys, and keeps the memory.
  void clear() {
    keys_.clear();
    slots_.assign(slots_.size(), 0);
  }

  std::size_t memory_bytes() const {
    return slots_.capacity() * sizeof(std::uint32_t) + keys_.capacity() * sizeof(Key);
  }

 private:
  // The slot that holds the key's number, or the free one where it belongs.
  std::size_t slot_of(const Key& key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash_of(key) & mask;
    while (slots_[slot] != 0 && !(keys_[slots_[slot] - 1] == key)) slot = (slot + 1) & mask;
    return slot;
  }

  void grow() {
    slots_.assign(2 * slots_.size(), 0);
    for (std::uint32_t i = 0; i < keys_.size(); ++i) slots_[slot_of(keys_[i])] = i + 1;
  }

  std::vector<Key> keys_;
  std::vector<std::uint32_t> slots_;  // a key's number + 1; 0: free. Their count is a power of two.
};

}  // namespace voxlist
