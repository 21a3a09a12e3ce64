#pragma once

#include <optional>
#include <vector>

#include "voxlist/voxels/edits/voxel_edits.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist {

/// What a map is for whose boxes were edited by hand.
enum class EditUse {
  /// Scans are matched with it. Where a box is erased or kept free, nothing is known: no scan is
  /// placed by what is there, and none is blamed for it. What is kept blocked changes nothing, for
  /// no laser sees a wall that was drawn by hand.
  kMatching,
  /// Planners read it: `occupied` and `passed` are occupied and free cells (FreeSpace). What is
  /// erased is not occupied any more; what is kept free or blocked is that alone.
  kPlanning,
};

/// A map with its edits. It has the same bits however it came about.
class EditedMap {
 public:
  /// Without edits: it costs nothing.
  explicit EditedMap(EditUse use) : use_(use) {}

  /// Takes a map as it is now, with these boxes in the place of those before. `changed`: what has
  /// changed in the map since it was looked at: nothing, where it had no boxes and gets some.
  /// Returns what has changed here.
  ChangedBlocks take(const OccupancyMap& map, std::vector<PlacedBox> boxes,
                     const ChangedBlocks& changed);

  /// Follows blocks that changed in the map since; what has changed here.
  ChangedBlocks follow(const OccupancyMap& map, const ChangedBlocks& changed);

  /// The map with its edits: where they leave it alone it is the map itself.
  const OccupancyMap& of(const OccupancyMap& map) const { return edited_ ? edited_->map : map; }

 private:
  void make_anew(const OccupancyMap& map, const std::vector<PlacedBox>& boxes);

  struct Edited {
    VoxelEdits occupied, passed;
    OccupancyMap map;
  };

  EditUse use_;
  std::optional<Edited> edited_;
};

}  // namespace voxlist
