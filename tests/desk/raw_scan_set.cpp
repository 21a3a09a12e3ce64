#include "tests/desk/raw_scan_set.h"

#include <fmt/core.h>

#include <cmath>
#include <filesystem>

#include "tests/desk/scan_set.h"
#include "tests/simulation/swept_laser.h"
#include "voxlist/geometry/mount.h"
#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/world/robot.h"
#include "voxlist/simulation/world/tour.h"
#include "voxlist/simulation/world/world.h"

namespace voxlist::test {
namespace {

constexpr double kFirst_s = 1.0, kPeriod_s = 0.5;

simulation::Trajectory make_drive(const simulation::Building& building) {
  simulation::DriveConfig config;
  config.speed_max_mps = 1.0;
  config.turn_rate_max_dps = 60.0;
  return simulation::drive(simulation::plan_tour(building, {}), config);
}

simulation::SweptLaser laser() {
  return {.rays = 3840,
          .rings = 16,
          .range_sd_m = 0.0,
          .T_base_laser = mount_pose({0.2, 0.0, 1.0}, 0.0, 10.0, 30.0)};
}

// A sweep as a PLY file.
std::string ply_of(const simulation::LaserSweep& sweep) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\n"
      "property float y\nproperty float z\nproperty float time\n"
      "property uchar ring\nend_header\n",
      sweep.points.size());
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const Eigen::Vector3f& point = sweep.points[i];
    text += fmt::format("{:.5f} {:.5f} {:.5f} {:.7f} {}\n", point.x(), point.y(), point.z(),
                        sweep.after_s[i], sweep.rings[i]);
  }
  return text;
}

std::string row(std::int64_t utime_us, const Pose2& pose) {
  return fmt::format("{},{:.9f},{:.9f},{:.9f}\n", utime_us, pose.x_m, pose.y_m, pose.yaw_rad);
}

}  // namespace

RawScanSet::RawScanSet() : drive_(make_drive(simulation::make_building({}))) {}

void RawScanSet::write(const std::string& folder) const {
  std::filesystem::create_directories(folder);
  const simulation::World world(simulation::make_building({}));
  std::string poses = "index,utime_us,x_m,y_m,yaw_rad\n", odometry = "utime_us,x_m,y_m,yaw_rad\n";
  for (int scan = 0; scan < kScans; ++scan) {
    const double start_s = kFirst_s + kPeriod_s * scan;
    write_text(fmt::format("{}/scan_{}.ply", folder, scan),
               ply_of(sweep(world, drive_, laser(), start_s, 1)));
    const std::int64_t utime_us = std::llround(start_s * 1e6);
    poses += fmt::format("{},{}", scan, row(utime_us, truth(utime_us)));
  }
  for (double t_s = 0.5; t_s < kFirst_s + kPeriod_s * kScans; t_s += 0.02)
    odometry += row(std::llround(t_s * 1e6), drive_.at(t_s));
  write_text(folder + "/poses.csv", poses);
  write_text(folder + "/odometry.csv", odometry);
}

std::string RawScanSet::settings() {
  return "[[cloud_adapter.sensor]]\nchannel = \"LASER_3D\"\nmount_x_m = 0.2\nmount_z_m = 1.0\n"
         "mount_pitch_deg = 10\nmount_yaw_deg = 30\ntime_channel = \"time\"\n";
}

Pose2 RawScanSet::truth(std::int64_t utime_us) const {
  return drive_.at(static_cast<double>(utime_us) * 1e-6);
}

}  // namespace voxlist::test
