#pragma once

#include <string>
#include <vector>

namespace voxlist::planning {

/// What planners must know of a robot's body. It is as wide as a circle and as tall as a cylinder,
/// and stands on the floor: `[[robot]]` in a settings file.
struct RobotProfile {
  /// Ends the names of its channels and files: letters, digits and underscores.
  std::string name = "robot";
  double radius_m = 0.3;
  double height_m = 1.2;
  double step_m = 0.03;
  double clearance_m = 0.05;
  double sensor_height_m = 0.3;

  template <class Visitor>
  void visit(Visitor& v) {
    v("name", name, "ends the names of its channels and files: letters, digits, underscores");
    v("radius_m", radius_m, "of the circle that it stands in", 0.01, 10.0);
    v("height_m", height_m, "of its highest part above the floor", 0.05, 10.0);
    v("step_m", step_m, "what its wheels get over, up or down", 0.005, 1.0);
    v("clearance_m", clearance_m, "kept between its highest part and what hangs above", 0.0, 2.0);
    v("sensor_height_m", sensor_height_m, "of its virtual 2D scan above the floor", 0.0, 10.0);
  }

  /// What must be clear above the floor.
  double clear_height_m() const { return height_m + clearance_m; }
};

/// The robots of a settings file, which several services read (config::root_section, or a member
/// visit_root of a service's settings that calls visit).
struct RobotProfiles {
  std::vector<RobotProfile> listed;

  template <class Visitor>
  void visit(Visitor& v) {
    v("robot", listed, "a robot that shares the map; one of the defaults where there is none");
  }

  /// Those that are listed; where none is, one of the defaults.
  std::vector<RobotProfile> in_use() const;
};

/// Why planners cannot use these together, such as a name that two have; empty when they can.
std::string why_invalid(const RobotProfiles& robots);

}  // namespace voxlist::planning
