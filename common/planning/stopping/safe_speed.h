#pragma once

#include <Eigen/Core>
#include <vector>

namespace voxlist::planning {

/// A round robot that can turn on the spot, and what its brakes do.
struct StoppingRobot {
  double radius_m = 0.3;
  double brakes_mps2 = 1.0;  ///< it slows down by this at least
  double reaction_s = 0.15;  ///< from a command to the wheels
  double top_speed_mps = 1.0;
  /// It keeps so far from everything where it stands, and more the faster it is.
  double margin_m = 0.03, margin_s = 0.1;
};

/// Something that must not be touched, in base.
struct Thing {
  Eigen::Vector2d position;
  double radius_m = 0.0;
  Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();
  /// It may be elsewhere than its velocity says, by this much more with each second (m/s).
  double strays_mps = 0.0;
};

/// What a robot knows of its surroundings, in base.
struct Surroundings {
  std::vector<Thing> things;
  /// How far the floor is confirmed in each direction: that of sector i is i * step_rad.
  std::vector<float> ground_seen_to_m;
  double step_rad = 0.0;
  double age_s = 0.0;  ///< how long ago that was
  /// The scanner looks at one place once in this time.
  double sweep_s = 1.0;
  /// Something may come from where nothing was seen as near as this, from base (m).
  double steps_in_m = 1.75;
};

/// The speed (m/s) from which the robot stands in time, while it turns by `turn_radps`: before
/// anything that is known can be in its way, before the floor's end, and before what steps in
/// `steps_in_m` ahead just after the scanner has looked there. 0: it must not drive, but may turn
/// on the spot. What it is nearer to than its margin it may only leave. It is one row of the
/// dynamic window approach (Fox, Burgard, Thrun 1997): the row of one turn rate.
double safe_speed_mps(const Surroundings& around, double turn_radps, const StoppingRobot& robot);

/// The greatest speed from which a robot that notices `late_s` later stands within `gap_m`.
double stopping_speed_mps(double gap_m, double late_s, double brakes_mps2);

}  // namespace voxlist::planning
