#include "voxlist/simulation/scanner/mirror_scanner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "voxlist/geometry/elementary.h"
#include "voxlist/simulation/random.h"

namespace voxlist::simulation {
namespace {

using Eigen::Vector3d;
using Met = SimulatedBeam::Met;

constexpr double kPi = std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kStep_rad = kPi / 180.0;

double metres(std::optional<double> range_m) { return range_m.value_or(kInfinity); }

double whole_millimetres(double range_m) { return std::round(range_m * 1e3) / 1e3; }

}  // namespace

std::vector<Box> MirrorScannerConfig::robot_body() {
  const Box deck{{0.0, 0.0, 0.2}, {0.17, 0.17, 0.15}, 0.0};
  const Box housing{{0.0, 0.0, 0.43}, {0.09, 0.0775, 0.08}, 0.0};
  return {deck, housing};
}

MirrorScanner::MirrorScanner(const World& world, const Trajectory& truth,
                             const MirrorScannerConfig& config, std::uint64_t seed)
    : world_(world),
      truth_(truth),
      config_(config),
      mirror_(config.mirror),
      motor_(config.motor),
      seed_(seed) {}

SimulatedBeam MirrorScanner::trace(double t_s, double beam_rad) const {
  return trace(t_s, beam_rad, motor_.angle_rad(t_s));
}

SimulatedBeam MirrorScanner::trace(double t_s, double beam_rad, double psi_rad) const {
  const Vector3d base_to_laser{0.0, 0.0, config_.mount_height_m - config_.mirror.height_m};
  const auto [sine, cosine] = elementary::sine_cosine(beam_rad);
  const Vector3d out{0.0, cosine, sine};
  Vector3d origin = Vector3d::Zero();

  SimulatedBeam beam{Met::kNothing, false, kInfinity, 0.0, base_to_laser, out};
  const auto meets = [&beam](Met what, double after_m) {
    if (beam.path_m + after_m >= beam.range_m) return;
    beam.met = what;
    beam.range_m = beam.path_m + after_m;
  };

  meets(Met::kArm, metres(mirror_.arm_range_m(origin, out, psi_rad)));
  const auto plate = mirror_.meet(origin, out, psi_rad);
  if (plate && plate->distance_m < beam.range_m) {
    if (plate->part == TurningMirror::Part::kEdge)
      meets(Met::kEdge, plate->distance_m);
    else {
      beam.reflected = true;
      beam.path_m = plate->distance_m;
      beam.direction_base = plate->reflected;
      origin = plate->distance_m * out;
      beam.origin_base = base_to_laser + origin;
      beam.range_m = kInfinity;
      beam.met = Met::kNothing;
      meets(Met::kArm, metres(mirror_.arm_range_m(origin, plate->reflected, psi_rad)));
      for (const Box& box : config_.body)
        meets(Met::kBody, metres(box.range_m(beam.origin_base, beam.direction_base)));
    }
  }
  const Pose2 T_map_base = truth_.at(t_s);
  const Vector3d direction_map = Pose2{0.0, 0.0, T_map_base.yaw_rad} * beam.direction_base;
  meets(Met::kWorld, metres(world_.range(T_map_base * beam.origin_base, direction_map, t_s)));
  return beam;
}

LaserLine MirrorScanner::measure(std::int64_t utime_us, double first_angle_rad) const {
  Random random(seed_, ~static_cast<std::uint64_t>(utime_us));
  const double begin_s = static_cast<double>(utime_us) * 1e-6;
  const double beam_period_s = kStep_rad / (2.0 * kPi * config_.turns_per_second);
  LaserLine line{
      utime_us + std::llround(config_.latency_s * 1e6), first_angle_rad, kStep_rad, {}, {}};
  const auto beams = static_cast<std::size_t>((kPi - first_angle_rad) / kStep_rad + 1.0 + 1e-9);
  for (std::size_t i = 0; i < beams; ++i) {
    const double t_s = begin_s + static_cast<double>(i) * beam_period_s;
    const double noise = config_.range_sd_m * random.normal();
    const double range = trace(t_s, line.angle_rad(i)).range_m + noise;
    line.ranges_m.push_back(range > config_.range_max_m
                                ? std::numeric_limits<float>::infinity()
                                : static_cast<float>(whole_millimetres(std::max(range, 0.0))));
  }
  return line;
}

}  // namespace voxlist::simulation
