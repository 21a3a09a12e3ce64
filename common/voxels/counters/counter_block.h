#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "voxlist/voxels/counters/cell_store.h"
#include "voxlist/voxels/counters/counter_rule.h"

namespace voxlist {

/// The counters of a block's 512 cells in four bit planes: bit i of planes[p] is bit p of cell i's
/// counter. 0 is unknown; a count is stored as its distance to the lowest one and 1 more.
struct CounterBlock {
  alignas(64) std::array<BlockBits, 4> planes{};

  bool operator==(const CounterBlock&) const = default;

  /// What is known of each cell.
  BlockBits known() const;

  /// The stored value of a cell.
  unsigned value(std::size_t cell) const;
  void set(std::size_t cell, unsigned value);
};

/// Changes counters as a rule says, 128 cells at a time: about 50 operations on bits where nothing
/// was hit.
class CounterUpdate {
 public:
  explicit CounterUpdate(const CounterRule& rule);

  using Cells = std::span<const std::uint64_t, kWordsInBlock>;

  /// Counts one pass, or where a cell is hit one hit alone. Returns whether a counter changed:
  /// those at an end of their range may not.
  bool count(Cells passed, Cells hit, CounterBlock& block) const;

  /// Cells whose count is 0 or more.
  BlockBits occupied(const CounterBlock& block) const;

 private:
  unsigned hit_, pass_, zero_, highest_;  // as stored
};

}  // namespace voxlist
