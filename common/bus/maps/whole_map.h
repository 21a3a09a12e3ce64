#pragma once

#include <optional>
#include <vector>

#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::bus {

/// A whole map on its way, in the chunks that split_map() makes of it, packed until each is sent: a
/// map of 6 million blocks waits in 0.25 GB.
class WholeMap {
 public:
  /// `word`: which map it is; its blocks are the map's. Throws std::length_error above kMaxChunks.
  WholeMap(MapChange word, const OccupancyMap& map);

  std::size_t size() const { return chunks_.size(); }

  /// Bytes of a chunk's message.
  std::size_t bytes(std::size_t chunk) const;

  /// The message of a chunk, which is forgotten here. Call it once for each.
  map_update_t take(std::size_t chunk);

 private:
  map_update_t header_;
  std::vector<std::optional<PackedBlocks>> chunks_;
};

}  // namespace voxlist::bus
