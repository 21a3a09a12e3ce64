#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <list>
#include <optional>
#include <vector>
#include <voxlist/map_update_t.hpp>

#include "voxlist/bus/counters.h"
#include "voxlist/bus/maps/packed_blocks.h"
#include "voxlist/geometry/pose.h"

namespace voxlist::bus {

/// base_version of a whole map.
inline constexpr std::int64_t kWholeMap = -1;

/// Blocks in one message, of both kinds together: 60 kB, which fits one UDP packet, so that nothing
/// is lost but whole chunks.
inline constexpr std::int32_t kBlocksPerChunk = 780;

/// Chunks of one change: 12 million blocks, 0.9 GB. A floor of 200 x 150 m with its ceiling,
/// furnished, has 5.7 million.
inline constexpr std::int32_t kMaxChunks = 16'000;

/// Block coordinates are within +-this: 84 km at 0.02 m, what a VoxelMap takes (kVoxelLimit / 8).
inline constexpr std::int32_t kMaxBlockCoordinate = 1 << 19;

/// Edges of a map's voxels, and of its coarser cells that rays passed.
struct MapResolution {
  double occupied_m = 0.0;
  double passed_m = 0.0;

  bool operator==(const MapResolution&) const = default;
};

/// What turns one version of the map into another: the new contents of the blocks that changed (all
/// zero bits: the block is empty now), or the whole map, or nothing but a newer time.
struct MapChange {
  /// Time of the newest cloud that the mapper has decided on, microseconds.
  std::int64_t utime_us = 0;
  std::int64_t map_id = 0;
  /// Keyframes in the map after the change, how often they were moved, and how often the map was
  /// edited by hand.
  std::int64_t version = 0;
  /// Version before it; kWholeMap: replaces whatever was; `version`: nothing changed, there are no
  /// blocks.
  std::int64_t base_version = kWholeMap;
  MapResolution resolution;
  MapBlocks blocks;
  /// How often keyframes were moved so far; how the newest one was, the last time.
  std::int64_t moves = 0;
  Pose2 T_new_old{};
  /// How often the map was edited so far.
  std::int64_t edits = 0;
  /// More of its blocks, where it is a large one that came in chunks.
  std::vector<PackedBlocks> packed{};

  /// Calls visit(MapBlocks) for all of its blocks, some at a time.
  template <class Visit>
  void for_each_part(const Visit& visit) const {
    visit(blocks);
    for (const PackedBlocks& part : packed) visit(part.unpacked());
  }

  bool is_whole() const { return base_version == kWholeMap; }
};

/// The change as messages for MAP_UPDATE, at least one. Blocks are put in a fixed order, so that
/// chunks of two sendings of one change fit together. Throws std::length_error above kMaxChunks.
std::vector<map_update_t> split_map(MapChange change);

/// Throws std::length_error above kMaxChunks.
void check_chunks(std::size_t chunks);

/// Puts chunks together again, whatever their order, with duplicates and losses, in bounded memory.
/// What it hands out always builds on what it handed out before. It believes whoever sends:
/// service::MapFollower lets through what is the mapper's.
class MapAssembler {
 public:
  /// Takes a chunk. Returns the changes that are now complete and fit, to be applied in this order:
  /// mostly none or one. A whole map in two sendings may be put together of both.
  std::vector<MapChange> add(const map_update_t& message);

  /// Holds nothing from now on, and waits for a whole map.
  void forget();

  /// What the last change handed out led to; nothing before the first.
  struct Held {
    std::int64_t utime_us;
    std::int64_t map_id;
    std::int64_t version;
    MapResolution resolution;
  };
  const std::optional<Held>& held() const { return held_; }

  /// By fault (map_faults.h), and "bad_chunk" (contradicts other chunks), "older" (than what is
  /// held, or a repetition of it), "duplicate", "abandoned" (changes given up before they were
  /// complete or fitted).
  const Counters& counters() const { return counters_; }

 private:
  // A change of which chunks are still missing, or that builds on a version not held yet.
  struct Assembly {
    MapChange change;
    std::vector<std::optional<PackedBlocks>> chunks;
    std::int32_t missing;
  };

  bool is_older(const MapChange& change) const;
  bool is_far_from_held(const map_update_t& message) const;
  bool builds_on_held(const MapChange& change) const;
  Assembly* assembly_of(const map_update_t& message);
  void put(const map_update_t& message, Assembly& assembly);
  std::vector<MapChange> take_ready();
  MapChange take(std::list<Assembly>::iterator ready);
  void hold(const MapChange& change);
  void abandon(std::list<Assembly>::iterator assembly);
  void abandon_useless();
  void bound_memory();

  std::optional<Held> held_;
  Eigen::AlignedBox3d box_;  // of the held map's blocks, and its origin (m)
  // Oldest first.
  std::list<Assembly> assemblies_;
  std::size_t pending_blocks_ = 0;
  Counters counters_;
};

}  // namespace voxlist::bus
