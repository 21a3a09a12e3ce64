#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "voxlist/bus/channels.h"
#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/laser_line.h"
#include "voxlist/geometry/mirror_state.h"
#include "voxlist/geometry/uncertain_pose.h"

namespace voxlist::bus {

/// Points (m, of a cloud) and positions (m, in the map) farther out than these are no measurement.
/// They also keep voxel coordinates far from overflow.
inline constexpr float kMaxPoint_m = 1e4F;
inline constexpr double kMaxPosition_m = 1e6;

/// What became of a pointcloud_t.
struct ReceivedCloud {
  /// Nothing when the message is refused.
  std::optional<Cloud> cloud;

  /// Why it is refused, as a counter's name; empty when it is not.
  std::string refusal;

  /// Points left out: not finite, beyond kMaxPoint_m, or 0,0,0 (or where their ray started), which
  /// stands for "nothing came back".
  std::int64_t dropped_points = 0;
};

/// A cloud of the map, with its place in the map.
struct PosedCloud {
  std::int64_t map_id = 0;

  /// 0 for the map's first.
  std::int32_t index = 0;

  Pose3 T_map_base = Pose3::Identity();

  /// The points, in base.
  Cloud cloud;
};

/// Takes points and, where channels origin_x, origin_y, origin_z are there, ray origins; other
/// channels are ignored. Refuses "bad_utime", "partial_origins" (one or two of the three),
/// "repeated_channel", "ragged_arrays".
ReceivedCloud from_message(const pointcloud_t& message);

/// The pose alone. Nullopt unless it is finite, near enough, its quaternion a unit one and its
/// utime sane.
std::optional<StampedPose3> from_message(const pose_t& message);

/// Nullopt unless pose, utime and index are sane and origins are as many as points, or none.
/// Points as for pointcloud_t.
std::optional<PosedCloud> from_message(const keyframe_t& message);

/// Most beams that a line may have: half a turn in steps of 0.1 deg.
inline constexpr std::size_t kMaxBeams = 1801;

/// Nullopt unless utime and angles are sane, ranges are 1 to kMaxBeams, and intensities are as many
/// or none. Ranges that are negative or beyond kMaxPoint_m become NaN.
std::optional<LaserLine> from_message(const planar_lidar_t& message);

/// Nullopt unless utime, state and numbers are sane.
std::optional<MirrorState> from_message(const mirror_state_t& message);

planar_lidar_t to_message(const LaserLine& line);

mirror_state_t to_message(const MirrorState& state);

/// `seq` counts up by one a message.
pointcloud_t to_message(const Cloud& cloud, const std::string& frame_id, std::int32_t seq);

/// Velocities and accelerations are 0.
pose_t to_message(const StampedPose3& pose);
pose_t to_message(const StampedPose2& pose);

/// Where a person thinks that the robot is (T_map_base). Nullopt unless it is finite and near
/// enough, its standard deviations are positive, and its utime is sane.
std::optional<UncertainPose> from_message(const pose_hint_t& message);

/// A planar pose and its covariance, in the arrays of a message: x, y, yaw; row by row.
void write(const UncertainPose& from, double (&pose)[3], double (&covariance)[9]);

/// A transform T_a_b, with the time that it is of.
rigid_transform_t to_transform(const StampedPose2& T_a_b);

keyframe_t to_message(const PosedCloud& keyframe);

/// Whether times like this can be subtracted from each other without overflow: not negative, not
/// absurdly late.
bool is_sane_utime(std::int64_t utime_us);

}  // namespace voxlist::bus
