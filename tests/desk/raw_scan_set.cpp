#include "tests/desk/raw_scan_set.h"

#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "tests/desk/scan_set.h"
#include "voxlist/geometry/mount.h"
#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/world/robot.h"
#include "voxlist/simulation/world/tour.h"
#include "voxlist/simulation/world/world.h"

namespace voxlist::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kColumns = 240, kRings = 16;
constexpr double kSweep_s = 0.1;
constexpr double kFirst_s = 1.0, kPeriod_s = 0.5;

simulation::Trajectory make_drive(const simulation::Building& building) {
  simulation::DriveConfig config;
  config.speed_max_mps = 1.0;
  config.turn_rate_max_dps = 60.0;
  return simulation::drive(simulation::plan_tour(building, {}), config);
}

Pose3 T_base_laser() { return mount_pose({0.2, 0.0, 1.0}, 0.0, 10.0, 30.0); }

Eigen::Vector3d direction(int column, int ring) {
  const double azimuth_rad = -2.0 * kPi * column / kColumns;
  const double elevation_rad = (2.0 * ring - 15.0) * kPi / 180.0;
  return {std::cos(azimuth_rad) * std::cos(elevation_rad),
          std::sin(azimuth_rad) * std::cos(elevation_rad), std::sin(elevation_rad)};
}

// The sweep that begins at a time, as rows of a PLY file.
std::string rows_of(const simulation::World& world, const simulation::Trajectory& drive,
                    double start_s, int& n) {
  std::string rows;
  for (int column = 0; column < kColumns; ++column) {
    const double after_s = kSweep_s * column / (kColumns - 1);
    const Pose3 T = to_pose3(drive.at(start_s + after_s)) * T_base_laser();
    for (int ring = 0; ring < kRings; ++ring) {
      const Eigen::Vector3d ray = direction(column, ring);
      const auto range_m = world.range(T.translation(), T.linear() * ray, start_s);
      if (!range_m) continue;
      const Eigen::Vector3d point = *range_m * ray;
      rows += fmt::format("{:.5f} {:.5f} {:.5f} {:.7f} {}\n", point.x(), point.y(), point.z(),
                          after_s, ring);
      ++n;
    }
  }
  return rows;
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
    int n = 0;
    const std::string rows = rows_of(world, drive_, start_s, n);
    write_text(fmt::format("{}/scan_{}.ply", folder, scan),
               fmt::format("ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\n"
                           "property float y\nproperty float z\nproperty float time\n"
                           "property uchar ring\nend_header\n{}",
                           n, rows));
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
