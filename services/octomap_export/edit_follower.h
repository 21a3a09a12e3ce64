#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/bus/maps/edit_convert.h"
#include "voxlist/service/inputs/mapper_word.h"

namespace voxlist::bus {
class Health;
}

namespace voxlist::services {

/// Which boxes the mapper's map has that were edited by hand: what MAP_EDITS says, where that is of
/// the map that the mapper's word tells of. What was missed is asked for.
class EditFollower {
 public:
  using Word = service::MapperWord::Word;

  explicit EditFollower(bus::Health& health) : health_(health) {}

  void take(const map_edits_t& message);

  /// The boxes of that map, where they are other ones than were handed out last.
  std::optional<std::vector<PlacedBox>> news(const Word& word);

  /// Whether those that were handed out are the map's. One that was never edited has none.
  bool follows(const Word& word) const { return word.edits == 0 || is_of(held_, word); }

  /// Whether to ask for MAP_EDITS now.
  bool is_due(const Word& word, std::int64_t now_us);

  /// What was handed out is gone.
  void start_over() { held_ = {}; }

 private:
  static bool is_of(const bus::EditedBoxes& boxes, const Word& word) {
    return boxes.map_id == word.map_id && boxes.edits == word.edits && boxes.moves == word.moves;
  }

  bus::Health& health_;
  bus::EditedBoxes heard_, held_;  // said last; handed out last
  std::optional<std::int64_t> missed_since_us_, asked_us_;
};

}  // namespace voxlist::services
