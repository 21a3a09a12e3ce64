#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/foreign/foxglove/messages.h"
#include "voxlist/geometry/cloud.h"

namespace voxlist {
class health_t;
class localisation_t;
class obstacles_t;
class pixel_map_t;
class planar_lidar_t;
class rigid_transform_t;
class traversability_t;
}  // namespace voxlist

namespace voxlist::foreign {

/// Frames, as others know them.
inline const std::string kMapFrame = "map", kOdomFrame = "odom", kBaseFrame = "base";

/// x, y, z.
std::vector<PackedField> point_fields();
void pack(const Eigen::Vector3d& point, Packed& to);

// Our messages as others know them; nothing where a message makes no sense.

std::string cloud_message(const Cloud& cloud_base);

/// The modes of a pose; as points, with the probability of each.
std::optional<std::string> candidates_message(const localisation_t& message);
std::optional<std::string> candidate_points_message(const localisation_t& message);

/// TRACKING, AMBIGUOUS or LOST.
std::string state_message(const localisation_t& message);

/// Cells in base, each with its type (obstacles_t) and a colour.
std::optional<std::string> obstacles_message(const obstacles_t& message);

/// Cells of one byte: how likely they are occupied (0 free, 127 unknown, 255 occupied), or what
/// they are (traversability_t).
std::optional<std::string> grid_message(const pixel_map_t& message);
std::optional<std::string> grid_message(const traversability_t& message);

/// What moves, as posts that are gone when OBSTACLES no longer tells of them.
std::optional<std::string> movers_message(const obstacles_t& message);

/// A 2D scan in base. A beam without a return has no number there: NaN, or +infinity.
std::optional<std::string> scan_message(const planar_lidar_t& message);

std::string health_message(const health_t& message);

/// T_map_odom.
std::optional<StampedPose3> transform_of(const rigid_transform_t& message);

}  // namespace voxlist::foreign
