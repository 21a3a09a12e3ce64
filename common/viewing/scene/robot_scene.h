#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/bus/maps/edit_convert.h"
#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/viewing/scene/board.h"
#include "voxlist/viewing/scene/keyframe_poses.h"
#include "voxlist/viewing/scene/other_robots.h"
#include "voxlist/viewing/scene/travelled.h"

namespace voxlist {
class health_t;
class keyframe_t;
class localisation_t;
class map_octree_t;
class obstacles_t;
class pointcloud_t;
class pose_t;
class traversability_t;
class uncertain_pose_t;
}  // namespace voxlist

namespace voxlist::viewing {

/// What the bus says of the robot, put on a board. Each take() has the time at which the message
/// came, by the clock of whoever calls (us).
class RobotScene {
 public:
  /// `most_points`: of a cloud that is shown.
  explicit RobotScene(std::size_t most_points, const std::vector<OtherRobotPlace>& others = {})
      : most_points_(most_points), others_(others) {}

  void take(const localisation_t& message, std::int64_t now_us);
  void take(const pose_t& message, std::int64_t now_us);
  void take(const uncertain_pose_t& message, std::int64_t now_us);
  void take(const obstacles_t& message, std::int64_t now_us);
  void take(const health_t& message, std::int64_t now_us);
  void take(const bus::EditedBoxes& edits, std::int64_t now_us);
  void take(const map_octree_t& message, std::int64_t now_us);
  void take(const traversability_t& message, std::int64_t now_us);

  /// The path moves with the map's keyframes.
  void take(const keyframe_t& message, std::int64_t now_us);

  /// The first keyframe to ask the mapper for now, if one is due.
  std::optional<std::int32_t> keyframe_due(std::int64_t now_us) { return keyframes_.due(now_us); }

  /// A cloud stands where its LOCALISATION says, which comes later; a slice at the newest POSE.
  void take_cloud(const pointcloud_t& message, std::int64_t now_us);
  void take_slice(const pointcloud_t& message, std::int64_t now_us);

  /// What a relay brings of another robot, on a channel of OtherRobots::kChannels; why it is left
  /// out.
  bus::Fault take_other(const std::string& channel, bus::Bytes bytes, std::int64_t now_us);

  /// Notes keyframes that were moved.
  void take(const bus::MapChange& change, std::int64_t now_us);

  /// The map is another one.
  void start_over(std::int64_t now_us);

  /// Forgets all but "hello".
  void clear();

  /// Whether edits by hand of this map were told.
  bool knows_edits() const { return knows_edits_; }

  Board& board() { return board_; }
  const Board& board() const { return board_; }

 private:
  struct WaitingCloud {
    std::int64_t utime_us = 0;
    std::vector<std::uint8_t> points;
  };
  struct Pose {
    std::int64_t utime_us = 0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    double yaw_rad = 0.0;
  };

  void place_cloud(const localisation_t& message, std::int64_t now_us);

  const std::size_t most_points_;
  Board board_;
  KeyframePoses keyframes_;
  Travelled travelled_;
  OtherRobots others_;
  std::optional<std::int64_t> map_id_;
  std::int32_t state_ = -1;
  std::int64_t since_us_ = 0;  // of the state
  std::optional<WaitingCloud> cloud_;
  std::optional<Pose> pose_;
  std::int64_t slices_ = 0;
  std::int64_t moves_ = 0;
  bool knows_edits_ = false;
};

}  // namespace voxlist::viewing
