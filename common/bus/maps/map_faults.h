#pragma once

#include <cstdint>
#include <string>

namespace voxlist {
class map_update_t;
}

namespace voxlist::bus {

/// Farthest that a map reaches from its origin, along x and y (m): nobody drives a robot farther
/// from where its map began, and a block beyond it makes every map coarser that spans it.
inline constexpr double kMapReach_m = 10'000.0;

/// What is wrong with a MAP_UPDATE by itself: no mapper makes it.
enum class MapFault {
  kNone,
  kTime,        ///< no time in microseconds
  kVersion,     ///< versions that do not follow from each other
  kChunk,       ///< numbers of chunks or blocks that split_map() does not make
  kResolution,  ///< edges of voxels that no map has
  kFarBlock,    ///< a block beyond kMapReach_m, or kilometres from the rest of the map
  kTooLarge,    ///< a map that does not fit this machine
};

/// The first fault of a chunk, whatever the map. Costs nothing but a look at each block.
MapFault fault_of(const map_update_t& message);

/// One word, for counters. kNone: "".
const char* name(MapFault fault);

/// The fault in words for people, such as "has blocks kilometres away"; empty for kNone.
const char* sentence(MapFault fault);

/// Whether a map of so many blocks, and what is made of it, fits a machine of this memory.
bool fits_memory(std::int64_t blocks, std::int64_t machine_bytes);

}  // namespace voxlist::bus
