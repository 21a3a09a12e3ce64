#pragma once

#include <cstdint>
#include <vector>

namespace voxlist::simulation {

/// For a time the rotor does not do what the clock says.
struct MotorFault {
  double from_s = 0.0, to_s = 0.0;
  double gain = 1.0;          ///< steps per edge: 0 stalls, -1 turns back, 0.9 drags
  double missed_steps = 0.0;  ///< lost all at once, at from_s
  bool clock_lost = false;    ///< the motor turns on, but no edge is seen
};

/// A stepper motor that turns the mirror, and the clock that drives it.
struct StepperMotorConfig {
  std::vector<double> sweep_s{1.0};  ///< the beam once round (half a turn of the mirror), for each
  std::vector<double> from_s{0.0};   ///< part of the run that begins here; the first at 0
  int steps_per_turn = 400;
  double start_deg = 20.0;  ///< the shaft's angle at the time 0
  bool staircase = false;   ///< stands between edges; else turns smoothly
  bool reversed = false;    ///< for good
  std::vector<MotorFault> faults;
};

/// The true angle of the mirror's shaft over time, from -infinity on.
class StepperMotor {
 public:
  /// Throws std::invalid_argument when speeds are none, not positive, or out of order.
  explicit StepperMotor(StepperMotorConfig config);

  /// Not wrapped.
  double angle_rad(double t_s) const;

  /// When the clock's edge number `edge` comes; edge 0 is at the time 0. With each the rotor goes
  /// one step; turning smoothly, it is at the step's place just then.
  double edge_s(std::int64_t edge) const;

  /// Whether the clock's line shows what happens at a time.
  bool clock_seen(double t_s) const;

  /// One step, radians.
  double step_rad() const;

 private:
  double steps_per_second(std::size_t speed) const;
  double clock_steps(double t_s) const;

  const StepperMotorConfig config_;
  std::vector<double> steps_;  // of the clock where each speed begins
};

}  // namespace voxlist::simulation
