#include "tests/bench/adapter/stream.h"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "voxlist/bus/convert.h"
#include "voxlist/geometry/mount.h"
#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/world/robot.h"
#include "voxlist/simulation/world/tour.h"

namespace voxlist::bench {
namespace {

constexpr double kHeight_m = 1.0, kPitch_deg = 10.0, kOdometryPeriod_s = 0.02;

simulation::SweptLaser mounted(simulation::SweptLaser laser) {
  laser.T_base_laser = mount_pose({0.2, 0.0, kHeight_m}, 0.0, kPitch_deg, 0.0);
  return laser;
}

std::int64_t to_us(double seconds) { return std::llround(seconds * 1e6); }

pointcloud_t to_message(simulation::LaserSweep sweep, double start_s) {
  Cloud cloud;
  cloud.utime_us = to_us(start_s);
  cloud.points = std::move(sweep.points);
  pointcloud_t message = bus::to_message(cloud, "laser", 0);
  message.n_channels = 3;
  message.channel_names = {"intensity", "ring", "time"};
  message.channels = {std::vector<float>(cloud.points.size(), 1.0F), std::move(sweep.rings),
                      std::move(sweep.after_s)};
  return message;
}

simulation::Trajectory drive_through(const simulation::Building& building) {
  simulation::DriveConfig config;
  config.speed_max_mps = 1.0;
  config.turn_rate_max_dps = 60.0;
  return simulation::drive(simulation::plan_tour(building, {}), config);
}

}  // namespace

std::vector<StreamKind> stream_kinds() {
  const simulation::SweptLaser rings16{.rays = 30'000, .rings = 16};
  simulation::SweptLaser rings64{.rays = 65'000, .rings = 64, .low_deg = -22.5, .high_deg = 22.5};
  const simulation::SweptLaser rosette{.rays = 30'000, .rings = 0, .high_deg = 35.0};
  std::vector<StreamKind> kinds{{"16 rings", mounted(rings16)}, {"64 rings", mounted(rings64)}};
  rings64.rays = 130'000;
  kinds.push_back({"64 rings", mounted(rings64)});
  kinds.push_back({"non-repetitive", mounted(rosette)});
  return kinds;
}

Stream make_stream(const StreamKind& kind, double seconds, std::uint64_t seed) {
  const simulation::Building building = simulation::make_building({.seed = static_cast<int>(seed)});
  const simulation::World world(building);
  Stream stream{drive_through(building), {}, {}};
  for (std::uint64_t i = 0; static_cast<double>(i) * kind.laser.sweep_s < seconds; ++i) {
    const double start_s = static_cast<double>(i) * kind.laser.sweep_s;
    stream.clouds.push_back(
        to_message(sweep(world, stream.drive, kind.laser, start_s, seed * 1000 + i), start_s));
    stream.clouds.back().seq = static_cast<std::int32_t>(i);
  }
  const simulation::Trajectory wheels = simulation::wheel_odometry(stream.drive, {}, seed);
  for (double t_s = 0.0; t_s < seconds + 1.0; t_s += kOdometryPeriod_s)
    stream.odometry.push_back(bus::to_message(StampedPose2{to_us(t_s), wheels.at(t_s)}));
  return stream;
}

std::string settings_of(const StreamKind& kind) {
  return fmt::format(
      "[mapper]\nfolder = \"\"\n[[cloud_adapter.sensor]]\nchannel = \"{}\"\nmount_x_m = {}\n"
      "mount_z_m = {}\nmount_pitch_deg = {}\ntime_channel = \"time\"\n",
      kLaserChannel, kind.laser.T_base_laser.translation().x(), kHeight_m, kPitch_deg);
}

}  // namespace voxlist::bench
