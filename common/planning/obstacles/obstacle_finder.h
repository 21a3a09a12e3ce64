#pragma once

#include <optional>

#include "voxlist/geometry/odometry_buffer.h"
#include "voxlist/planning/obstacles/moving_tracks.h"
#include "voxlist/planning/obstacles/obstacle_memory.h"
#include "voxlist/planning/obstacles/seen_void.h"
#include "voxlist/planning/rays/beam_spacing.h"

namespace voxlist::planning {

/// Clouds, or slices of clouds, and odometry in; what is round the robot out. It needs no map.
///
/// With odometry, what was seen before moves along; without it only what is newer than
/// window_without_odometry_s counts, and nothing is known to move. Cost: about 3 ms a slice of the
/// mirror scanner.
class ObstacleFinder {
 public:
  /// What a cloud is.
  enum class Part {
    kWhole,  ///< everything round the robot, at once
    kSlice,  ///< one of many that make a sweep
  };

  /// Throws std::invalid_argument for settings with which nothing could be seen.
  explicit ObstacleFinder(const ObstacleConfig& config);

  /// T_odom_base, and roll and pitch where it measures them.
  void add_odometry(const StampedPose2& T_odom_base, const Tilt& tilt = {});

  /// Takes the next cloud, in base at its time.
  ObstacleScan take(const Cloud& cloud_base, Part part);

  /// Forgets all.
  void clear();

 private:
  Pose3 pose_at(std::int64_t utime_us);
  void move_to(const Pose3& T_odom_base, const Cloud& cloud);
  void forget_if_tilted(const std::vector<Ray>& news);
  ObstacleScan describe(std::int64_t utime_us, Part part);
  void tell_nearest(const std::vector<TypedPoint>& points, ObstacleScan& scan) const;

  const ObstacleConfig config_;
  const LocalGrid grid_;
  OdometryBuffer odometry_;
  BeamSpacing spacing_;
  RayWindow window_;
  ObstacleMemory memory_;
  SeenVoid void_;
  MovingTracks tracks_;
  bool has_odometry_ = false;
  Pose3 T_odom_base_ = Pose3::Identity();
  double scanner_height_m_ = 0.0;
  std::int64_t newest_us_ = 0;
  LocalFloor ground_;  // as of the last cloud; empty: none
};

}  // namespace voxlist::planning
