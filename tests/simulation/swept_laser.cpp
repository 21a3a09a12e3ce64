#include "tests/simulation/swept_laser.h"

#include <cmath>
#include <numbers>

#include "voxlist/geometry/angle.h"
#include "voxlist/simulation/random.h"

namespace voxlist::simulation {
namespace {

constexpr double kPi = std::numbers::pi;

// A rosette's petals and turns a second: no small whole numbers are in the same ratio.
constexpr double kPetals_hz = 121.3, kTurns_hz = 46.7;

struct Ray {
  double after_s = 0.0;
  int ring = 0;
  Eigen::Vector3d direction;
};

Eigen::Vector3d towards(double azimuth_rad, double elevation_rad) {
  return {std::cos(azimuth_rad) * std::cos(elevation_rad),
          std::sin(azimuth_rad) * std::cos(elevation_rad), std::sin(elevation_rad)};
}

// The rings of a column at once, as such lasers fire.
Ray ring_ray(const SweptLaser& laser, int i) {
  const int ring = i % laser.rings;
  const double share = static_cast<double>(i - ring) / laser.rays;
  const double elevation_deg =
      laser.low_deg + (laser.high_deg - laser.low_deg) * ring / std::max(1, laser.rings - 1);
  return {laser.sweep_s * share, ring,
          towards(kPi * (1.0 - 2.0 * share), elevation_deg * kRadPerDeg)};
}

Ray rosette_ray(const SweptLaser& laser, double start_s, int i) {
  const double after_s = laser.sweep_s * i / laser.rays, t_s = start_s + after_s;
  const double off_axis_rad = laser.high_deg * kRadPerDeg * std::sin(2.0 * kPi * kPetals_hz * t_s);
  const double turn_rad = 2.0 * kPi * kTurns_hz * t_s;
  return {after_s,
          0,
          {std::cos(off_axis_rad), std::sin(off_axis_rad) * std::cos(turn_rad),
           std::sin(off_axis_rad) * std::sin(turn_rad)}};
}

}  // namespace

LaserSweep sweep(const World& world, const Trajectory& drive, const SweptLaser& laser,
                 double start_s, std::uint64_t seed) {
  Random random(seed);
  LaserSweep sweep;
  for (int i = 0; i < laser.rays; ++i) {
    const Ray ray = laser.rings > 0 ? ring_ray(laser, i) : rosette_ray(laser, start_s, i);
    const double t_s = start_s + ray.after_s;
    const Pose3 T_map_laser = to_pose3(drive.at(t_s)) * laser.T_base_laser;
    const auto hit_m =
        world.range(T_map_laser.translation(), T_map_laser.linear() * ray.direction, t_s);
    if (!hit_m || *hit_m > laser.range_max_m) continue;
    const double range_m = *hit_m + laser.range_sd_m * random.normal();
    sweep.points.push_back((range_m * ray.direction).cast<float>());
    sweep.after_s.push_back(static_cast<float>(ray.after_s));
    sweep.rings.push_back(static_cast<float>(ray.ring));
  }
  return sweep;
}

}  // namespace voxlist::simulation
