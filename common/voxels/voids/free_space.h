#pragma once

#include "voxlist/voxels/counters/counter_map.h"
#include "voxlist/voxels/occupancy_map.h"
#include "voxlist/voxels/voids/marked_scan.h"

namespace voxlist {

/// Which cells of kPassedResolution_m planners may hold to be free, and which to be occupied, by
/// counters of what rays hit and passed: as an OctoMap of that resolution would have it.
class FreeSpace {
 public:
  FreeSpace();

  /// Counts what a scan says of a block.
  void count(const MarkedScan::Block& seen) {
    counters_.add(seen.at, CellStore::Block(seen.passed), CellStore::Block(seen.hit));
  }

  /// Brings map() up to date with the counters. Returns the blocks that have other free or occupied
  /// cells now.
  ChangedBlocks follow();

  /// `occupied` holds the occupied cells, `passed` the free ones; a cell in neither is unknown.
  const OccupancyMap& map() const { return map_; }

  /// The counters, for who takes scans out.
  CounterMap& counters() { return counters_; }
  const CounterMap& counters() const { return counters_; }

 private:
  CounterMap counters_;
  OccupancyMap map_;
};

}  // namespace voxlist
