#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/viewing/blocks/block_set.h"
#include "voxlist/viewing/blocks/map_levels.h"

namespace voxlist::viewing {

/// Takes at most `most` blocks out of the set and writes each as it is now. A record is
/// position (3 x int16, blocks), layers (uint8: bit z is set where layer z is not empty), 0
/// (uint8), changed_s (uint32), and 8 bytes for each such layer, lowest first: bit x + 8 y.
/// Little-endian.
std::vector<std::uint8_t> take_records(const MapLevel& level, std::size_t most, BlockSet& blocks);

}  // namespace voxlist::viewing
