#include "tests/bench/adapter/mounted_drive.h"

#include <cmath>
#include <utility>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "tests/simulation/swept_laser.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/event_log.h"
#include "voxlist/geometry/mount.h"
#include "voxlist/simulation/world/robot.h"
#include "voxlist/simulation/world/tour.h"

namespace voxlist::bench {
namespace {

constexpr std::int64_t kStart_us = 1'700'000'000'000'000;
constexpr double kOdometryPeriod_s = 0.02;

std::int64_t at(double seconds) { return kStart_us + std::llround(seconds * 1e6); }

pointcloud_t to_message(simulation::LaserSweep sweep, std::int64_t utime_us) {
  Cloud cloud;
  cloud.utime_us = utime_us;
  cloud.points = std::move(sweep.points);
  pointcloud_t message = bus::to_message(cloud, "laser", 0);
  message.n_channels = 1;
  message.channel_names = {"time"};
  message.channels = {std::move(sweep.after_s)};
  return message;
}

}  // namespace

void write_drive(const std::string& log, const Mounted& laser, double seconds, std::uint64_t seed) {
  const simulation::Building building = simulation::make_building({.seed = static_cast<int>(seed)});
  const simulation::World world(building);
  const simulation::Trajectory drive =
      simulation::drive(simulation::plan_tour(building, {}), {.speed_max_mps = 0.8});
  const simulation::Trajectory wheels = simulation::wheel_odometry(drive, {}, seed);
  const simulation::SweptLaser swept{
      .rays = laser.rays,
      .T_base_laser = mount_pose({laser.x_m, laser.y_m, laser.z_m}, laser.roll_deg, laser.pitch_deg,
                                 laser.yaw_deg)};
  bus::EventLogWriter writer(log);
  double next_sweep_s = 0.1;
  std::uint64_t sweeps = 0;
  for (double t_s = 0.0; t_s < seconds; t_s += kOdometryPeriod_s) {
    writer.write(bus::kOdometry, at(t_s), bus::to_message(StampedPose2{at(t_s), wheels.at(t_s)}));
    if (t_s < next_sweep_s + swept.sweep_s) continue;
    const std::int64_t utime_us = at(next_sweep_s + laser.latency_ms * 1e-3);
    writer.write(
        bus::Channel<pointcloud_t>{"LASER_3D"}, at(t_s),
        to_message(sweep(world, drive, swept, next_sweep_s, seed * 10'000 + sweeps++), utime_us));
    next_sweep_s += swept.sweep_s;
  }
  writer.close();
}

}  // namespace voxlist::bench
