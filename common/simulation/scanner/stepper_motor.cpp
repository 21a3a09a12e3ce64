#include "voxlist/simulation/scanner/stepper_motor.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace voxlist::simulation {
namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

StepperMotor::StepperMotor(StepperMotorConfig config) : config_(std::move(config)) {
  const std::vector<double>&sweep_s = config_.sweep_s, &from_s = config_.from_s;
  if (sweep_s.empty() || sweep_s.size() != from_s.size() || from_s.front() != 0.0 ||
      !std::is_sorted(from_s.begin(), from_s.end()) || config_.steps_per_turn <= 0 ||
      *std::min_element(sweep_s.begin(), sweep_s.end()) <= 0.0)
    throw std::invalid_argument("stepper motor: its speeds make no sense");
  steps_.push_back(0.0);
  for (std::size_t i = 1; i < from_s.size(); ++i)
    steps_.push_back(steps_.back() + (from_s[i] - from_s[i - 1]) * steps_per_second(i - 1));
}

double StepperMotor::step_rad() const { return 2.0 * kPi / config_.steps_per_turn; }

double StepperMotor::steps_per_second(std::size_t speed) const {
  return config_.steps_per_turn / (2.0 * config_.sweep_s[speed]);
}

double StepperMotor::clock_steps(double t_s) const {
  std::size_t i = steps_.size() - 1;
  while (i > 0 && config_.from_s[i] > t_s) --i;
  const double steps = steps_[i] + (t_s - config_.from_s[i]) * steps_per_second(i);
  constexpr double kRounding = 1e-9;  // at an edge's own time the step is done
  return config_.staircase ? std::floor(steps + kRounding) : steps;
}

double StepperMotor::edge_s(std::int64_t edge) const {
  const auto steps = static_cast<double>(edge);
  std::size_t i = steps_.size() - 1;
  while (i > 0 && steps_[i] > steps) --i;
  return config_.from_s[i] + (steps - steps_[i]) / steps_per_second(i);
}

double StepperMotor::angle_rad(double t_s) const {
  double steps = clock_steps(t_s);
  for (const MotorFault& fault : config_.faults) {
    if (t_s < fault.from_s) continue;
    const double during = clock_steps(std::min(t_s, fault.to_s)) - clock_steps(fault.from_s);
    steps -= (1.0 - fault.gain) * during + fault.missed_steps;
  }
  return config_.start_deg * kPi / 180.0 + (config_.reversed ? -1.0 : 1.0) * steps * step_rad();
}

bool StepperMotor::clock_seen(double t_s) const {
  return std::none_of(config_.faults.begin(), config_.faults.end(), [t_s](const MotorFault& f) {
    return f.clock_lost && t_s >= f.from_s && t_s < f.to_s;
  });
}

}  // namespace voxlist::simulation
