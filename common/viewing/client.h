#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "voxlist/viewing/blocks/block_set.h"
#include "voxlist/viewing/blocks/map_levels.h"
#include "voxlist/viewing/scene/board.h"
#include "voxlist/viewing/scene/frame.h"

namespace voxlist::viewing {

/// What one client has still to get: blocks by number, and how far it has seen the board. Content
/// is read when it is sent, so a slow client costs one bit a block, and gets the newest.
class Client {
 public:
  /// The next frame, while its socket can take one: what is new on the board, and blocks, coarse
  /// ones first. After a large topic blocks have their turn. Nothing: it has all.
  std::optional<Frame> next(const Board& board, const MapLevels& levels, std::int64_t now_us);

  /// A block has changed. Of an epoch that the client has not begun it counts all the same.
  void add(const MapLevels::Changed& changed) { blocks_[changed.level].add(changed.number); }

 private:
  void follow(const MapLevels& levels);
  std::optional<Frame> next_topic(const Board& board, std::int64_t now_us);
  std::optional<Frame> next_blocks(const MapLevels& levels);

  std::array<BlockSet, kLevels> blocks_;
  std::uint32_t epoch_ = 0;
  std::int64_t seen_ = 0;
  bool is_turn_of_blocks_ = false;
};

}  // namespace voxlist::viewing
