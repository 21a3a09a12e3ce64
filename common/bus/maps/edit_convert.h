#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/voxels/edits/placed_box.h"

namespace voxlist {
class map_edit_t;
class map_edits_t;
}  // namespace voxlist

namespace voxlist::bus {

/// What somebody wants edited.
struct EditWish {
  /// Tells it from other wishes.
  std::int64_t utime_us = 0;
  std::int64_t map_id = 0;
  /// Nothing: the edit of this id is taken back.
  std::optional<EditKind> kind;
  std::int64_t id = 0;
  Eigen::AlignedBox3d box;
};

/// Nullopt unless time and action make sense. Whether a map can have the box is for the mapper to
/// say.
std::optional<EditWish> from_message(const map_edit_t& message);
map_edit_t to_message(const EditWish& wish);

/// The boxes of a map that were edited by hand.
struct EditedBoxes {
  /// The time of the newest cloud that the mapper has decided on.
  std::int64_t utime_us = 0;
  std::int64_t map_id = 0;
  /// How often boxes were edited and keyframes were moved so far.
  std::int64_t edits = 0, moves = 0;
  std::vector<std::int64_t> ids;
  std::vector<PlacedBox> boxes;
};

/// Nullopt where it refuses an edit, and unless a map can have such boxes.
std::optional<EditedBoxes> from_message(const map_edits_t& message);
map_edits_t to_message(const EditedBoxes& boxes);

}  // namespace voxlist::bus
