#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/bus/wire.h"
#include "voxlist/geometry/pose.h"

namespace voxlist {
class localisation_t;
class pose_t;
}  // namespace voxlist

namespace voxlist::viewing {

class Board;

/// Where another robot's map lies in the one that is shown: `[[viewer.other_robot]]` in a settings
/// file.
struct OtherRobotPlace {
  std::string name;
  double x_m = 0.0, y_m = 0.0, yaw_deg = 0.0;

  template <class Visitor>
  void visit(Visitor& v) {
    v("name", name, "of another robot in the fleet");
    v("x_m", x_m, "where its map's origin is in this robot's map", -1e6, 1e6);
    v("y_m", y_m, "and across", -1e6, 1e6);
    v("yaw_deg", yaw_deg, "how its map is turned in this one", -360.0, 360.0);
  }
};

/// The other robots of a fleet, as a relay brings their POSE and LOCALISATION: on topics
/// "other/NAME" the state and the last pose in the map that is shown, null where it has no place
/// there: that map has to be the other robot's, too, or settings to tell how the two lie. And on
/// "service/robot NAME" the same for the list of those who report.
class OtherRobots {
 public:
  /// Names come from the network: more robots are left out.
  static constexpr std::size_t kMostRobots = 100;

  /// Patterns of the channels that take() knows.
  static const std::vector<std::string> kChannels;

  explicit OtherRobots(const std::vector<OtherRobotPlace>& places);

  /// A message of ROBOT/POSE or ROBOT/LOCALISATION. `map_id`: of the map that is shown, if there is
  /// one. Returns why it is left out, kNone when it is not.
  bus::Fault take(const std::string& channel, bus::Bytes bytes, std::optional<std::int64_t> map_id,
                  std::int64_t now_us, Board& board);

  /// Forgets all robots, but not how their maps lie.
  void clear() { robots_.clear(); }

 private:
  struct Robot {
    std::string state = "unknown";
    std::optional<std::int64_t> map_id;
  };

  bus::Fault take_state(const std::string& name, bus::Bytes bytes);
  bus::Fault take_pose(const std::string& name, bus::Bytes bytes,
                       std::optional<std::int64_t> map_id, std::int64_t now_us, Board& board);
  std::optional<Pose2> T_map_other(const std::string& name,
                                   std::optional<std::int64_t> map_id) const;

  std::map<std::string, Pose2> places_;
  std::map<std::string, Robot> robots_;
};

}  // namespace voxlist::viewing
