#include "tests/bench/obstacles/mirror_drive.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/tilt.h"
#include "voxlist/simulation/random.h"
#include "voxlist/simulation/scanner/mirror_scanner.h"

namespace voxlist::bench {
namespace {

using simulation::TurningMirror;

constexpr double kLine_s = 1.0 / 75.0, kBeam_s = kLine_s / 360.0;
constexpr int kFirstBeam_deg = 25, kLastBeam_deg = 155;
// Left out where the mirror is edge-on, as cloud_assembler does; and what is too near or far.
constexpr double kBlindUp_rad = 15.0 * kRadPerDeg, kNearest_m = 0.3, kFarthest_m = 8.183;
// The wheels stand so far from the middle.
constexpr double kWheels_m = 0.2;

}  // namespace

MirrorDrive::MirrorDrive(const SlabWorld& world, const MirrorDriveConfig& config)
    : world_(world), config_(config), mirror_(simulation::TurningMirrorConfig{}) {
  simulation::Random random(config.seed, 77);
  scale_ = random.uniform(0.99, 1.01);
  start_rad_ = random.uniform(0.0, kTurn_rad);
  rocking_phase_rad_ = random.uniform(0.0, kTurn_rad);
}

Pose2 MirrorDrive::planar(double t_s) const {
  const double way_m = config_.speed_mps * t_s;
  return Pose2{config_.start_x_m, config_.y_m, config_.heading_rad} * Pose2{way_m, 0.0, 0.0};
}

Pose2 MirrorDrive::T_odom_base(double t_s) const {
  return {scale_ * config_.speed_mps * t_s, 0.0, 0.0};
}

Pose3 MirrorDrive::truth(double t_s) const {
  const Pose2 at = planar(t_s);
  const auto ground_m = [&](double ahead_m) {
    const Pose2 wheel = at * Pose2{ahead_m, 0.0, 0.0};
    return world_.ground_m({wheel.x_m, wheel.y_m, 1.5});
  };
  const double rear_m = ground_m(-kWheels_m), front_m = ground_m(kWheels_m);
  const double rock = config_.rocking_rad * std::sin(rocking_phase_rad_ + 6.1 * t_s);
  const double roll = config_.rocking_rad * std::sin(2.0 * rocking_phase_rad_ + 4.7 * t_s);
  const double pitch = std::atan2(rear_m - front_m, 2.0 * kWheels_m);
  return to_pose3(at, Tilt{(rear_m + front_m) / 2.0, roll, pitch + rock});
}

std::optional<double> MirrorDrive::range_m(double t_s, const Eigen::Vector3d& origin,
                                           const Eigen::Vector3d& direction) const {
  const Pose3 T = truth(t_s);
  return world_.range_m(T * origin, T.linear() * direction);
}

void MirrorDrive::add_beam(double t_s, double t_end_s, double beam_rad, double noise_m,
                           Cloud& cloud) const {
  const double psi = start_rad_ + std::numbers::pi * t_s / config_.sweep_s;
  if (std::abs(wrap_angle(2.0 * psi)) < kBlindUp_rad) return;
  const Eigen::Vector3d out(0.0, std::cos(beam_rad), std::sin(beam_rad));
  const Eigen::Vector3d laser(0.0, 0.0, config_.scanner_height_m - mirror_.config().height_m);
  const auto plate = mirror_.meet(Eigen::Vector3d::Zero(), out, psi);
  if (!plate || plate->part == TurningMirror::Part::kEdge) return;
  if (mirror_.arm_range_m(Eigen::Vector3d::Zero(), out, psi).value_or(1e9) < plate->distance_m)
    return;
  const Eigen::Vector3d at_mirror = plate->distance_m * out, origin = laser + at_mirror;
  if (mirror_.arm_range_m(at_mirror, plate->reflected, psi)) return;
  for (simulation::Box box : simulation::MirrorScannerConfig::robot_body()) {
    box.centre_m.z() += config_.scanner_height_m - 0.6;
    if (box.range_m(origin, plate->reflected)) return;
  }
  const auto range = range_m(t_s, origin, plate->reflected);
  if (!range || *range + plate->distance_m > kFarthest_m || *range < kNearest_m) return;
  const Pose3 T_end_then = to_pose3(T_odom_base(t_end_s).inverse() * T_odom_base(t_s));
  const Eigen::Vector3d end = origin + (*range + noise_m) * plate->reflected;
  cloud.points.push_back((T_end_then * end).cast<float>());
  cloud.origins.push_back((T_end_then * origin).cast<float>());
}

Cloud MirrorDrive::slice(double t_end_s) const {
  Cloud cloud;
  cloud.utime_us = std::llround(t_end_s * 1e6);
  simulation::Random random(config_.seed, static_cast<std::uint64_t>(cloud.utime_us));
  for (int line = 0; line < 5; ++line)
    for (int beam = kFirstBeam_deg; beam <= kLastBeam_deg; ++beam) {
      const double t_s = t_end_s - kSlice_s + line * kLine_s + beam * kBeam_s;
      add_beam(t_s, t_end_s, beam * kRadPerDeg, config_.range_sd_m * random.normal(), cloud);
    }
  return cloud;
}

}  // namespace voxlist::bench
