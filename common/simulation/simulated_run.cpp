#include "simulation/simulated_run.h"

#include <algorithm>
#include <cmath>

namespace voxlist {
namespace {

std::int64_t to_utime_us(double t_s) { return std::llround(t_s * 1e6); }

}  // namespace

SimulatedRun::SimulatedRun(const SimulationConfig& config)
    : config_(config),
      building_(make_building(config.building)),
      truth_(drive(plan_tour(building_, config.tour), config.drive)),
      odometry_(wheel_odometry(truth_, config.odometry, static_cast<std::uint64_t>(config.seed))),
      duration_s_(config.duration_s > 0.0 ? config.duration_s : truth_.duration_s()) {}

std::optional<SimulatedEvent> SimulatedRun::next() {
  const double sample_s = static_cast<double>(samples_) * odometry_.period_s();
  const double sweep_s = static_cast<double>(sweeps_ + 1) * config_.scanner.sweep_s;
  const bool sample_is_next = to_utime_us(sample_s) <= to_utime_us(sweep_s);
  if (std::min(sample_s, sweep_s) > duration_s_) return std::nullopt;
  if (sample_is_next) {
    ++samples_;
    return SimulatedOdometry{{to_utime_us(sample_s), odometry_.at(sample_s)}};
  }
  truth_told_ = !truth_told_;
  if (truth_told_) return SimulatedTruth{{to_utime_us(sweep_s), truth_.at(sweep_s)}};
  ++sweeps_;
  return scan_sweep(building_, truth_, config_.perfect_deskew ? truth_ : odometry_, sweep_s,
                    config_.scanner, static_cast<std::uint64_t>(config_.seed));
}

}  // namespace voxlist
