#include "tests/bench/follow/robots_eyes.h"

#include <cmath>
#include <numbers>

#include "tests/simulation/sphere_scan.h"
#include "voxlist/geometry/angle.h"
#include "voxlist/simulation/random.h"
#include "voxlist/simulation/scanner/mirror_scanner.h"

namespace voxlist::bench {
namespace {

using Part = planning::ObstacleFinder::Part;

constexpr int kLines = 5, kFirstBeam_deg = 25, kLastBeam_deg = 155;
constexpr double kLine_s = 1.0 / 75.0, kSlice_s = kLines * kLine_s, kSweep_s = 1.0;
constexpr double kRings_s = 0.1;
constexpr double kNoise_m = 0.01, kNearest_m = 0.3;
// Left out where the mirror is edge-on, as cloud_assembler does.
constexpr double kBlindUp_rad = 15.0 * kRadPerDeg;

obstacles_t to_message(const planning::ObstacleScan& scan) {
  obstacles_t message{};
  message.utime = scan.utime_us;
  message.radstep = static_cast<float>(scan.step_rad);
  message.n_bearings = static_cast<std::int32_t>(scan.ground_seen_to_m.size());
  message.nearest_m.assign(scan.nearest_m.begin(), scan.nearest_m.end());
  message.ground_seen_to_m = scan.ground_seen_to_m;
  for (const planning::MovingObstacle& m : scan.moving)
    message.moving.push_back(
        {{m.position.x(), m.position.y()}, {m.velocity_mps.x(), m.velocity_mps.y()}, m.radius_m});
  message.n_moving = static_cast<std::int32_t>(message.moving.size());
  return message;
}

simulation::World world_of(const simulation::Building& building, const std::vector<Pose2>& people) {
  std::vector<simulation::Trajectory> standing;
  for (const Pose2& person : people) standing.emplace_back(1.0, std::vector<Pose2>{person});
  return simulation::World(building, std::move(standing));
}

}  // namespace

RobotsEyes::RobotsEyes(FollowersLaser laser, std::uint64_t seed)
    : laser_(laser), seed_(seed), finder_(planning::ObstacleConfig{}) {}

double RobotsEyes::period_s() const {
  return laser_ == FollowersLaser::kMirror ? kSlice_s : kRings_s;
}

void RobotsEyes::move(double t_s, const Pose2& pose) {
  step_s_ = t_s - t_s_;
  t_s_ = t_s;
  if (poses_.empty()) poses_.push_back(pose);
  poses_.push_back(pose);
  finder_.add_odometry({std::llround(t_s * 1e6), pose});
}

std::optional<obstacles_t> RobotsEyes::look(const simulation::Building& building,
                                            const std::vector<Pose2>& people) {
  if (t_s_ < looked_s_ + period_s() - 1e-9) return std::nullopt;
  looked_s_ = t_s_;
  const simulation::World world = world_of(building, people);
  return laser_ == FollowersLaser::kMirror ? to_message(finder_.take(slice(world), Part::kSlice))
                                           : to_message(finder_.take(rings(world), Part::kWhole));
}

Cloud RobotsEyes::rings(const simulation::World& world) const {
  simulation::SphereScanConfig laser;
  laser.rays = 5'760;
  laser.rings = 16;
  laser.range_sd_m = kNoise_m;
  const auto utime_us = static_cast<std::int64_t>(std::llround(t_s_ * 1e6));
  Cloud cloud = simulation::scan_sphere(world, poses_.back(), laser,
                                        seed_ + static_cast<std::uint64_t>(utime_us));
  cloud.utime_us = utime_us;
  return cloud;
}

// The lines of the time since the last look, each beam from where the robot was then.
Cloud RobotsEyes::slice(const simulation::World& world) const {
  const simulation::Trajectory way(step_s_, poses_);
  const simulation::MirrorScanner scanner(world, way, {}, seed_);
  const Pose2 now = way.at(t_s_);
  Cloud cloud;
  cloud.utime_us = std::llround(t_s_ * 1e6);
  simulation::Random random(seed_, static_cast<std::uint64_t>(cloud.utime_us));
  for (int line = 0; line < kLines; ++line)
    for (int beam = kFirstBeam_deg; beam <= kLastBeam_deg; ++beam) {
      const double t_s = t_s_ - kSlice_s + (line + beam / 360.0) * kLine_s;
      const double psi = std::numbers::pi * t_s / kSweep_s;
      const double noise_m = kNoise_m * random.normal();
      if (std::abs(wrap_angle(2.0 * psi)) < kBlindUp_rad) continue;
      const simulation::SimulatedBeam met = scanner.trace(t_s, beam * kRadPerDeg, psi);
      if (met.met != simulation::SimulatedBeam::Met::kWorld || !met.reflected ||
          met.range_m > scanner.config().range_max_m || met.range_m - met.path_m < kNearest_m)
        continue;
      const Pose3 T_now_then = to_pose3(now.inverse() * way.at(t_s));
      cloud.points.push_back((T_now_then * met.point_base(met.range_m + noise_m)).cast<float>());
      cloud.origins.push_back((T_now_then * met.origin_base).cast<float>());
    }
  return cloud;
}

}  // namespace voxlist::bench
