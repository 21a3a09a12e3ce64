#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "voxlist/viewing/blocks/block_set.h"
#include "voxlist/viewing/blocks/map_levels.h"
#include "voxlist/viewing/blocks/space_levels.h"
#include "voxlist/viewing/scene/board.h"
#include "voxlist/viewing/scene/frame.h"

namespace voxlist::viewing {

/// What there is to show.
struct Content {
  const Board& board;
  const MapLevels& levels;
  const SpaceLevels& space;
};

/// What one client has still to get: blocks by number, and how far it has seen the board. Content
/// is read when it is sent, so a slow client costs one bit a block, and gets the newest.
class Client {
 public:
  /// The next frame, while its socket can take one: what is new on the board, and blocks, coarse
  /// ones first, then those of free and occupied space, if it wants them. After a large topic
  /// blocks have their turn. Nothing: it has all.
  std::optional<Frame> next(const Content& content, std::int64_t now_us);

  /// A block has changed. Of an epoch that the client has not begun it counts all the same.
  void add(const ChangedBlock& changed) { map_.blocks[changed.level].add(changed.number); }
  void add_space(const ChangedBlock& changed) { space_.blocks[changed.level].add(changed.number); }

  /// Whether it wants free and occupied space. Who wants it again gets all of it again.
  void want_space(bool on);
  bool wants_space() const { return wants_space_; }

 private:
  // Blocks of a map's levels that it has still to get.
  template <std::size_t N>
  struct Pending {
    std::array<BlockSet, N> blocks{};
    std::uint32_t epoch = 0;

    template <class Levels>
    void follow(const Levels& levels);
  };

  std::optional<Frame> next_topic(const Board& board, std::int64_t now_us);
  std::optional<Frame> next_blocks(const Content& content);
  std::optional<Frame> next_space(const SpaceLevels& space);

  Pending<kLevels> map_;
  Pending<kSpaceLevels> space_;
  bool wants_space_ = false;
  std::int64_t seen_ = 0;
  bool is_turn_of_blocks_ = false;
};

}  // namespace voxlist::viewing
