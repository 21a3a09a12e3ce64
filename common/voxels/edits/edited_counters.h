#pragma once

#include <span>
#include <vector>

#include "voxlist/voxels/counters/counter_map.h"
#include "voxlist/voxels/edits/block_edits.h"

namespace voxlist {

/// A map of counters with its edits: what is erased is unknown where it was occupied, what is kept
/// free or blocked is as sure as counters can be. It follows the map at the cost of what changed
/// there, and has the same counters as one made anew.
class EditedCounters {
 public:
  /// Takes all that the map has.
  EditedCounters(const CounterMap& map, const std::vector<PlacedBox>& boxes);

  /// Follows blocks of the map that changed, given by their numbers.
  void update(const CounterMap& map, std::span<const std::uint32_t> changed);

  CounterMap& map() { return edited_; }
  const CounterMap& map() const { return edited_; }

 private:
  void edit(const Voxel& at, const CounterBlock& unedited, const BlockBits& occupied);

  BlockEdits edits_;
  CounterMap edited_;
};

}  // namespace voxlist
