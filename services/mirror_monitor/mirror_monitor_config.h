#pragma once

#include <string>
#include <vector>

#include "voxlist/scanner/mirror/mirror_clock.h"

namespace voxlist::services {

/// Settings of the mirror monitor.
struct MirrorMonitorConfig {
  std::string clock = "none";
  int steps_per_revolution = 400;
  bool turns_backwards = false;
  bool staircase = false;
  std::vector<double> arm_angle_deg{90.0, 265.0};
  std::vector<double> arm_first_beam_deg{25.0, 120.0};
  std::vector<double> arm_last_beam_deg{60.0, 155.0};
  double arm_height_max_m = 0.075;

  template <class Visitor>
  void visit(Visitor& v) {
    v("clock", clock,
      "where the stepper's edges come from: gpio:gpiochip0/17, modem:/dev/ttyS0:cts (dcd, dsr, "
      "ri), text:/dev/ttyACM0@115200 (a line of microseconds for each edge), or none");
    v("steps_per_revolution", steps_per_revolution, "clock edges for one turn of the mirror", 4,
      100'000);
    v("turns_backwards", turns_backwards, "the mirror's angle psi falls as it turns");
    v("staircase", staircase,
      "the mirror stands still between the motor's steps; else it turns evenly");
    v("arm_angle_deg", arm_angle_deg,
      "of each blocking arm, one or two: mirror angle psi at the middle of its passage", -360.0,
      360.0);
    v("arm_first_beam_deg", arm_first_beam_deg, "of each arm: the first beam that it blocks", 0.0,
      180.0);
    v("arm_last_beam_deg", arm_last_beam_deg, "of each arm: the last beam that it blocks", 0.0,
      180.0);
    v("arm_height_max_m", arm_height_max_m,
      "above the laser's optical centre: above the arms that block, below the mirror's axis", 0.005,
      1.0);
  }
};

/// The settings as the mirror clock takes them. Throws std::invalid_argument for settings that make
/// no sense.
scanner::MirrorClockConfig mirror_clock_config(const MirrorMonitorConfig& config);

}  // namespace voxlist::services
