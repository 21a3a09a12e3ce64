#include "simulation/simulated_run.h"

#include <cmath>

namespace voxlist {
namespace {

std::int64_t to_utime_us(double t_s) { return std::llround(t_s * 1e6); }

}  // namespace

SimulatedRun::SimulatedRun(const SimulationConfig& config)
    : config_(config),
      building_(make_building(config.building)),
      truth_(drive(plan_tour(building_, config.tour), config.drive)),
      odometry_(wheel_odometry(truth_, config.odometry, config.seed)),
      duration_s_(config.duration_s > 0.0 ? config.duration_s : truth_.duration_s()) {}

std::optional<SimulatedEvent> SimulatedRun::next() {
  const double sample_s = static_cast<double>(sample_) * odometry_.period_s();
  if (truth_is_due_) {
    truth_is_due_ = false;
    ++sample_;
    return SimulatedTruth{{to_utime_us(sample_s), truth_.at(sample_s)}};
  }
  const double sweep_s = static_cast<double>(sweep_) * config_.scanner.sweep_s;
  if (to_utime_us(sweep_s) < to_utime_us(sample_s) && sweep_s <= duration_s_) {
    ++sweep_;
    return scan_sweep(building_, truth_, config_.perfect_deskew ? truth_ : odometry_, sweep_s,
                      config_.scanner, config_.seed);
  }
  if (sample_s > duration_s_) return std::nullopt;
  truth_is_due_ = true;
  return SimulatedOdometry{{to_utime_us(sample_s), odometry_.at(sample_s)}};
}

}  // namespace voxlist
