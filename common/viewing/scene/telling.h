#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "voxlist/bus/maps/edit_convert.h"
#include "voxlist/geometry/cloud.h"

namespace voxlist {
class health_t;
class localisation_t;
class obstacles_t;
class pointcloud_t;
class traversability_t;
class uncertain_pose_t;
}  // namespace voxlist

namespace voxlist::viewing {

// Messages as the JSON that the page reads (page/messages.js has the fields).

/// `since_us`: the time of the first message of this state.
std::string json_of(const localisation_t& message, std::int64_t since_us);
std::string json_of(const StampedPose3& T_map_base);
std::string json_of(const uncertain_pose_t& message);
std::string json_of(const health_t& message);
std::string json_of(const obstacles_t& message);
std::string json_of(const bus::EditedBoxes& edits);
/// Of the grid's place and size; its cells are bytes.
std::string json_of(const traversability_t& message);

/// The state's name: "TRACKING", "AMBIGUOUS", "LOST".
const char* name_of_state(std::int32_t state);

/// Whether a text can be a topic's name, which goes into JSON as it is.
bool is_topic_name(const std::string& text);

/// Why the localiser knows no place, for a person.
std::string why_lost(const localisation_t& message);

/// Chooses at most `most` points of a cloud evenly, as 3 x int16 each: centimetres in base. Points
/// that are not finite, or 300 m away, are left out.
std::vector<std::uint8_t> points_of(const pointcloud_t& message, std::size_t most);

}  // namespace voxlist::viewing
