#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/voxels/edits/placed_box.h"

namespace voxlist::mapping {

/// A box of the map that somebody edited by hand.
struct MapEdit {
  /// From 1 on, in the order in which they came; never given twice in one map.
  std::int64_t id = 0;
  EditKind kind = EditKind::kErase;
  /// Where it was in the map when it came.
  Eigen::AlignedBox3d box;
  /// The keyframe that was nearest to it: number in the map, time, and where it stood.
  std::size_t keyframe = 0;
  std::int64_t utime_us = 0;
  Pose2 T_map_keyframe{};
};

/// All boxes of a map that were edited by hand, in the order in which they came: where they
/// overlap, the last one holds.
struct MapEdits {
  std::int64_t map_id = 0;
  /// How often they were changed so far.
  std::int64_t changes = 0;
  std::int64_t next_id = 1;
  std::vector<MapEdit> edits;

  /// Why the box cannot be added to a map of these keyframes, for people; empty: it can.
  std::string refusal(const Eigen::AlignedBox3d& box, const std::vector<StampedPose3>& map) const;

  /// Adds a box. Returns its id. Precondition: no refusal.
  std::int64_t add(EditKind kind, const Eigen::AlignedBox3d& box,
                   const std::vector<StampedPose3>& map);

  /// Takes a box back. False when there is none of that id.
  bool remove(std::int64_t id);

  /// Adds those of another map, whose keyframes come in this one after the first `keyframes`.
  void append(const MapEdits& other, std::size_t keyframes);

  /// The boxes as they came.
  std::vector<Eigen::AlignedBox3d> boxes() const;

  /// Where the boxes are in a map whose keyframes stand there now. A box whose keyframe was lost
  /// stays where it was when it came.
  std::vector<PlacedBox> placed(const std::vector<StampedPose3>& map) const;
};

/// "erase", "free", "blocked".
const char* name_of(EditKind kind);

}  // namespace voxlist::mapping
