#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/geometry/pose.h"

namespace voxlist {
class keyframe_t;
}

namespace voxlist::viewing {

/// Where the map's keyframes are, as KEYFRAME tells: what was drawn beside one moves with it when
/// loops are closed.
class KeyframePoses {
 public:
  /// What MAP_UPDATE tells of the mapper's map.
  struct Map {
    std::int64_t map_id = 0, moves = 0, keyframes = 0;
  };
  void follow(const Map& map);

  /// The keyframe's number, if it stands elsewhere than it was told to before, or was not known.
  std::optional<std::size_t> take(const keyframe_t& message);

  /// T_map_base of a keyframe that was told.
  const Pose3& pose(std::size_t keyframe) const { return *keyframes_[keyframe].T_map_base; }

  /// The newest keyframe near a position of the map (m), of those that were told since the map was
  /// moved last; nothing: there is none.
  std::optional<std::size_t> near(const Eigen::Vector3d& position);

  /// The first keyframe to ask for now, at most once a second: one that near() named, and that was
  /// not told since the map was moved last.
  std::optional<std::int32_t> due(std::int64_t now_us);

 private:
  struct Keyframe {
    std::optional<Pose3> T_map_base;
    std::int64_t moves = -1;  // of the map when it was told
    bool is_named = false;
  };

  Map map_;
  std::vector<Keyframe> keyframes_;
  std::int64_t now_us_ = 0;
  std::optional<std::int64_t> asked_us_;
};

}  // namespace voxlist::viewing
