#include "voxlist/simulation/scanner/ideal_sweep.h"

#include <cmath>
#include <numbers>

#include "voxlist/geometry/angle.h"
#include "voxlist/simulation/random.h"

namespace voxlist::simulation {
namespace {

constexpr double kPi = std::numbers::pi;

bool blind(double phi_rad, const IdealSweepConfig& config) {
  const double from_up = std::abs(wrap_angle(phi_rad));
  return from_up < config.blind_up_deg * kRadPerDeg ||
         kPi - from_up < config.blind_down_deg * kRadPerDeg;
}

}  // namespace

Cloud scan_sweep(const MirrorScanner& scanner, const Trajectory& measured, double t_end_s,
                 const IdealSweepConfig& config, std::uint64_t seed) {
  const auto utime_us = static_cast<std::int64_t>(std::llround(t_end_s * 1e6));
  Random random(seed, static_cast<std::uint64_t>(utime_us));
  const Pose2 T_end_odom = measured.at(t_end_s).inverse();
  const int lines = static_cast<int>(std::lround(config.sweep_s * config.lines_per_second));

  Cloud cloud;
  cloud.utime_us = utime_us;
  for (int line = 0; line < lines; ++line)
    for (int angle = config.beam_first_deg; angle <= config.beam_last_deg; ++angle) {
      // The laser turns its beam once round in a line's time.
      const double into_s = (line + angle / 360.0) / config.lines_per_second;
      const double t = t_end_s - config.sweep_s + into_s;
      const double phi = 2.0 * kPi * into_s / config.sweep_s;
      if (blind(phi, config)) continue;
      const SimulatedBeam beam = scanner.trace(t, angle * kRadPerDeg, phi / 2.0);
      if (!beam.reflected || beam.met != SimulatedBeam::Met::kWorld) continue;
      const double range = beam.range_m + config.range_sd_m * random.normal();
      if (range < config.range_min_m || range > config.range_max_m) continue;
      const Pose2 T_end_then = T_end_odom * measured.at(t);
      cloud.points.push_back((T_end_then * beam.point_base(range)).cast<float>());
      cloud.origins.push_back((T_end_then * beam.origin_base).cast<float>());
    }
  return cloud;
}

}  // namespace voxlist::simulation
