#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "voxlist/geometry/pose.h"

namespace voxlist::foreign {

/// The kinds of Foxglove's messages that are written here.
enum class Kind {
  kPointCloud,
  kPoseInFrame,
  kPosesInFrame,
  kFrameTransform,
  kGrid,
  kLaserScan,
  kSceneUpdate,
  kLog
};

/// The type's full name, such as foxglove.PointCloud.
std::string name_of(Kind kind);

/// The type's definition, as MCAP and Foxglove want it: a serialised FileDescriptorSet.
std::string schema_of(Kind kind);

/// When, and in which frame.
struct Stamp {
  std::int64_t utime_us = 0;
  std::string frame;
};

/// The numbers that each point or cell has. `kUint8` is 1 byte long, `kFloat32` 4.
struct PackedField {
  enum class Type { kUint8, kFloat32 };
  std::string name;
  Type type;
};

/// Points or cells one after the other, each the numbers of `fields`, without gaps.
struct Packed {
  std::vector<PackedField> fields;
  std::string data;
};

/// Bytes of each point or cell.
std::uint32_t stride_of(const std::vector<PackedField>& fields);

/// Appends a number as a Packed's data has it.
void pack(float value, Packed& to);
void pack(std::uint8_t value, Packed& to);

/// A 2D grid: rows along x, from the lowest y.
struct PackedGrid {
  Pose3 T_frame_corner = Pose3::Identity();
  double cell_m = 0.0;
  std::uint32_t columns = 0;
  Packed cells;
};

/// Beams of a 2D laser in a frame's x-y plane, evenly spaced (rad, m).
struct Beams {
  double first_rad = 0.0, step_rad = 0.0;
  const std::vector<float>& ranges_m;
};

/// Something that moves: a post with an arrow as long as it goes in a second.
struct Mover {
  Eigen::Vector2d position, velocity_mps;
  double radius_m = 0.0;
};

/// The text without what is no ASCII: others refuse what is no UTF-8, and who sends it may send
/// anything.
std::string ascii(std::string text);

/// How bad a line of a log is.
enum class Level { kInfo, kWarning, kError };

// Encoded messages.
std::string point_cloud(const Stamp& stamp, const Packed& points);
std::string pose_in_frame(const Stamp& stamp, const Pose3& pose);
std::string poses_in_frame(const Stamp& stamp, const std::vector<Pose3>& poses);
/// T_frame_child.
std::string frame_transform(const Stamp& stamp, const std::string& child, const Pose3& transform);
std::string grid(const Stamp& stamp, const PackedGrid& grid);
std::string laser_scan(const Stamp& stamp, const Beams& beams);
/// All that move now; they are gone `lifetime_us` later.
std::string movers(const Stamp& stamp, const std::vector<Mover>& all, std::int64_t lifetime_us);
std::string log_line(std::int64_t utime_us, Level level, const std::string& name,
                     const std::string& message);

}  // namespace voxlist::foreign
