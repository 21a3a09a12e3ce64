#include "voxlist/planning/profiles/robot_profile.h"

#include <algorithm>
#include <set>

namespace voxlist::planning {
namespace {

// Longer names leave no room for the rest of a channel's name.
constexpr std::size_t kLongestName = 32;

bool fits_a_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

std::string why_invalid(const RobotProfile& robot) {
  if (robot.name.empty()) return "a robot has no name";
  const std::string who = "the robot's name \"" + robot.name + "\" ";
  if (robot.name.size() > kLongestName)
    return who + "is longer than " + std::to_string(kLongestName) + " letters";
  if (!std::ranges::all_of(robot.name, fits_a_name))
    return who + "may have letters, digits and underscores alone";
  if (robot.step_m >= robot.clear_height_m())
    return "the robot " + robot.name +
           " would step over what is as high as itself: set step_m "
           "below height_m";
  return {};
}

}  // namespace

std::vector<RobotProfile> RobotProfiles::in_use() const {
  return listed.empty() ? std::vector<RobotProfile>(1) : listed;
}

std::string why_invalid(const RobotProfiles& robots) {
  std::set<std::string> names;
  for (const RobotProfile& robot : robots.listed) {
    if (const std::string wrong = why_invalid(robot); !wrong.empty()) return wrong;
    if (!names.insert(robot.name).second) return "two robots are called \"" + robot.name + "\"";
  }
  return {};
}

}  // namespace voxlist::planning
