#pragma once

namespace voxlist {
class health_t;
class keyframe_t;
class localisation_t;
class map_edit_t;
class map_edits_t;
class map_octree_t;
class map_request_t;
class map_update_t;
class mirror_state_t;
class obstacles_t;
class pixel_map_t;
class pixel_map_t;
class planar_lidar_t;
class pointcloud_t;
class pose_hint_t;
class pose_t;
class rigid_transform_t;
class traversability_t;
class traversability_t;
class uncertain_pose_t;
}  // namespace voxlist

namespace voxlist::bus {

// The generated types; include <voxlist/pose_t.hpp> and the like where a message is made or read.

/// A channel's name, tied to the one type that travels on it.
template <class M>
struct Channel {
  const char* name;
};

/// One line of the 2D laser: ranges in metres, +infinity beyond the maximum, NaN without a
/// measurement; intensity 1 where the receiver was dazzled (no intensities: nowhere). Frame: laser.
/// Rate: 75 Hz. From laser_driver to mirror_monitor, cloud_assembler.
inline constexpr Channel<planar_lidar_t> kLaser{"LASER"};

/// Where the scanner's mirror is. Frame: scanner. Rate: each line of the laser.
/// From mirror_monitor to cloud_assembler.
inline constexpr Channel<mirror_state_t> kMirror{"MIRROR"};

/// One whole 3D scan. Frame: base, at the sweep's end. Rate: about 1 Hz.
/// It goes from cloud_assembler or cloud_adapter (or any 3D laser) to localiser, mapper and
/// obstacle_detector.
inline constexpr Channel<pointcloud_t> kCloud{"CLOUD"};

/// A part of a sweep, for low latency. Frame: base, at the part's end. Rate: about 15 Hz.
/// It goes from cloud_assembler or cloud_adapter to obstacle_detector.
inline constexpr Channel<pointcloud_t> kCloudSlice{"CLOUD_SLICE"};

/// Dead reckoning. Frame: odom (drifts, never jumps). Rate: 20-100 Hz.
/// From the robot base (or a simulator, or a recording) to cloud_assembler, cloud_adapter,
/// localiser.
inline constexpr Channel<pose_t> kOdometry{"ODOMETRY"};

/// Where the robot is, only while TRACKING. Frame: map (may jump). Rate: each cloud, and odometry's
/// rate between. From localiser to whoever drives the robot.
inline constexpr Channel<pose_t> kPose{"POSE"};

/// Each POSE once more, with its map and its covariance. Frame, rate and ways as POSE's.
inline constexpr Channel<uncertain_pose_t> kPoseCovariance{"POSE_COVARIANCE"};

/// T_map_odom, from odom to map: with the newest ODOMETRY it gives the pose at any time, T_map_base
/// = T_map_odom * T_odom_base. It jumps where POSE does, and changes slowly otherwise: odometry's
/// drift. Never of a pose that is not TRACKING. Rate: each tracked cloud with odometry.
/// The localiser tells it to planners that work in odom, or want poses at a rate of their own.
inline constexpr Channel<rigid_transform_t> kMapOdom{"T_MAP_ODOM"};

/// The true pose, where a simulator or a data set knows it. Frame: map. Rate: each cloud.
/// From the scan source to recordings only: no service may use it.
inline constexpr Channel<pose_t> kTruth{"TRUTH"};

/// What is known of each cloud's pose, and how sure it is. Frame: map. Rate: each cloud.
/// From localiser to mapper.
inline constexpr Channel<localisation_t> kLocalisation{"LOCALISATION"};

/// Blocks of the map that changed, of voxels and of cells that rays passed, in chunks
/// (map_chunks.h). Frame: map. Rate: each cloud; a whole map on request. From mapper to localiser.
inline constexpr Channel<map_update_t> kMapUpdate{"MAP_UPDATE"};

/// Cells that are free and cells that are occupied, by counters of what rays hit and passed: blocks
/// that changed, with the versions, chunks and requests of MAP_UPDATE (maps/README.md). Frame: map.
/// Rate: each added cloud, once somebody has asked; all of it on request. From mapper to planners
/// and viewers.
inline constexpr Channel<map_update_t> kFreeSpace{"FREE_SPACE"};

/// A cloud that went into the map, with its pose. Frame: base, pose in map. Rate: each added cloud.
/// From mapper to octomap_export, which needs the rays that voxels no longer have.
inline constexpr Channel<keyframe_t> kKeyframe{"KEYFRAME"};

/// Keyframes that one MAP_REQUEST brings at most: of 100,000 points they take 4 s on their way.
inline constexpr int kKeyframesAtOnce = 32;

/// Asks mapper for a whole map, for free space, for keyframes that were missed, or to save. Rate:
/// when needed. From localiser, octomap_export, scripts to mapper.
inline constexpr Channel<map_request_t> kMapRequest{"MAP_REQUEST"};

/// Where a person thinks that the robot is: where a lost one looks, too. Frame: map. Rate: on
/// command. From voxlist hint, or whoever knows, to localiser.
inline constexpr Channel<pose_hint_t> kPoseHint{"POSE_HINT"};

/// Asks mapper to edit a box of the map by hand. Frame: map. Rate: when a person does.
/// The desk tool and viewers send it to mapper, which answers on MAP_EDITS.
inline constexpr Channel<map_edit_t> kMapEdit{"MAP_EDIT"};

/// All boxes of the map that were edited by hand. Frame: map. Rate: on change, and on request.
/// Mapper sends it to octomap_export, viewers, and whoever asked for an edit.
inline constexpr Channel<map_edits_t> kMapEdits{"MAP_EDITS"};

/// The map as an OctoMap. Frame: map. Rate: on change, at most 1 Hz.
/// From octomap_export to planners.
inline constexpr Channel<map_octree_t> kOctomap{"OCTOMAP"};

/// The floor plan for one robot: GRID_ and TRAVERSABILITY_, each with the robot's name. Of GRID the
/// type is pixel_map_t (free, unknown, not free), of TRAVERSABILITY traversability_t (all types).
/// Frame: map. Rate: on change of the map. From grid_export to planners and viewers.
inline constexpr const char* kGridPrefix = "GRID_";
inline constexpr const char* kTraversabilityPrefix = "TRAVERSABILITY_";

/// A 2D scan for one robot, made of CLOUD: SCAN_ and SCAN_FAR_, each with the robot's name, of type
/// planar_lidar_t: the nearest point of each bearing within the robot's heights, and the furthest.
/// +infinity: nothing seen; NaN: no ray there. Frame: base. Rate: each cloud. From grid_export to
/// planners and localisers for flat worlds.
inline constexpr const char* kScanPrefix = "SCAN_";
inline constexpr const char* kScanFarPrefix = "SCAN_FAR_";

/// What stands, hangs and gapes in each bearing, how far the floor is seen, what moves; or why
/// nothing can be told. Frame: base. Rate: each slice, or cloud where there are no slices; 15 Hz
/// while it is blind. From obstacle_detector to planners.
inline constexpr Channel<obstacles_t> kObstacles{"OBSTACLES"};

/// How a service fares (health.h). Rate: 1 Hz.
/// From every service to whoever watches.
inline constexpr Channel<health_t> kHealth{"HEALTH"};

}  // namespace voxlist::bus
