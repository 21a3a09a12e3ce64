#include "simulation/mirror_scanner.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "simulation/random.h"

namespace voxlist {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kRadPerDeg = kPi / 180.0;

struct Beam {
  Vector3d origin, direction;  // base
  double inside_m;             // from the optical centre to the origin
};

// Reference: reflection at a mirror on an axis h above the optical centre, phi = 2 psi.
Beam reflect(double angle_rad, double phi_rad, const MirrorScannerConfig& config) {
  const double h = config.mirror_height_m;
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {{0.0, h * c / s, config.laser_height_m + h},
          {-s * std::sin(phi_rad), c, s * std::cos(phi_rad)},
          h / s};
}

bool blind(double phi_rad, const MirrorScannerConfig& config) {
  const double from_up = std::abs(wrap_angle(phi_rad));
  return from_up < config.blind_up_deg * kRadPerDeg ||
         kPi - from_up < config.blind_down_deg * kRadPerDeg;
}

// The range that the laser reports for a beam; none without a usable echo.
std::optional<double> measure(const Building& building, const Pose2& T_map_base, const Beam& beam,
                              const MirrorScannerConfig& config, Random& random) {
  const Vector3d direction_map = Pose2{0.0, 0.0, T_map_base.yaw_rad} * beam.direction;
  const auto outside = building.solid.range(T_map_base * beam.origin, direction_map);
  if (!outside) return std::nullopt;
  const double range = beam.inside_m + *outside + config.range_sd_m * random.normal();
  if (range < config.range_min_m || range > config.range_max_m) return std::nullopt;
  return range;
}

}  // namespace

Cloud scan_sweep(const Building& building, const Trajectory& truth, const Trajectory& measured,
                 double t_end_s, const MirrorScannerConfig& config, std::uint64_t seed) {
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
      const Beam beam = reflect(angle * kRadPerDeg, phi, config);
      const auto range = measure(building, truth.at(t), beam, config, random);
      if (!range) continue;
      const Pose2 T_end_then = T_end_odom * measured.at(t);
      const Vector3d hit = beam.origin + (*range - beam.inside_m) * beam.direction;
      cloud.points.push_back((T_end_then * hit).cast<float>());
      cloud.origins.push_back((T_end_then * beam.origin).cast<float>());
    }
  return cloud;
}

}  // namespace voxlist
