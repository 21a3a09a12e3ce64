#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/voxels/numbering.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::viewing {

/// Levels of detail that a client gets: the coarse one first, whose voxels are four times as large.
inline constexpr std::size_t kFine = 0, kCoarse = 1, kLevels = 2;
inline constexpr double kCoarser = 4.0;

/// The map as it is shown at one level. Blocks are numbered in the order in which they are met, and
/// keep their number, also when they are empty.
struct MapLevel {
  double edge_m = 0.0;
  Numbering<Voxel> positions{};
  std::vector<VoxelBlock> blocks;
  /// When each changed last: the map's time, seconds.
  std::vector<std::uint32_t> changed_s;

  std::uint32_t size() const { return static_cast<std::uint32_t>(blocks.size()); }

  /// Sets a block, at the map's time `now_s`. Its number, if it is another one now.
  std::optional<std::uint32_t> put(const Voxel& position, const VoxelBlock& bits,
                                   std::uint32_t now_s);
};

/// A block whose content is another one now, with its level.
struct ChangedBlock {
  std::size_t level;
  std::uint32_t number;
};

/// The map at two levels, kept in step with MAP_UPDATE. A change costs little when it comes; the
/// levels follow in refresh(), piece by piece.
class MapLevels {
 public:
  /// `detail_m`: edge of the fine level's voxels; the map's own where those are larger.
  explicit MapLevels(double detail_m) : detail_m_(detail_m) {}

  void apply(const bus::MapChange& change);

  /// Shows no map from now on.
  void forget();

  /// Works off some of what has changed, the coarse level first: at most about `work` look-ups of
  /// the map's blocks (some 50 ns each).
  void refresh(std::size_t work);

  /// Whether the levels show what the map holds.
  bool is_fresh() const { return stale_[kFine].empty() && stale_[kCoarse].empty(); }

  /// Each call tells what is new since the last one.
  std::vector<ChangedBlock> take_changed();

  const MapLevel& level(std::size_t which) const { return levels_[which]; }
  const VoxelMap& map() const { return map_.occupied; }

  /// Counts up when the map became another one, so that numbers of blocks begin anew.
  std::uint32_t epoch() const { return epoch_; }

 private:
  void start_over(const bus::MapChange& change);
  void mark_stale(const Voxel& block);
  void mark_all_stale();
  std::size_t work_of_block(std::size_t level) const;
  void refresh_block(std::size_t level, const Voxel& block);

  const double detail_m_;
  OccupancyMap map_;
  std::int64_t map_id_ = 0;
  std::uint32_t now_s_ = 0;
  std::uint32_t epoch_ = 0;
  std::array<MapLevel, kLevels> levels_;
  std::array<std::set<Voxel>, kLevels> stale_;
  std::vector<ChangedBlock> changed_;
};

}  // namespace voxlist::viewing
