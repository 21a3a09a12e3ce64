// Plays a robot that drives its tour through a simulated building again and again: CLOUD and
// ODOMETRY at 10 Hz of its own time, as fast as the localiser answers. Writes a row for each
// minute: minute, clouds so far, how many of them were answered by TRACKING. Usage: lap_driver
// MINUTES [ROOMS] [RAYS]
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>
#include <voxlist/localisation_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "tests/simulation/sphere_scan.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/simulation/random.h"
#include "voxlist/simulation/world/robot.h"
#include "voxlist/simulation/world/tour.h"

namespace {

using namespace voxlist;

constexpr std::int64_t kBegin_us = 1'700'000'000'000'000, kPeriod_us = 100'000;
constexpr double kNoise_m = 0.015;

// A lap without noise.
struct Lap {
  Lap(int rooms, int rays) {
    simulation::BuildingConfig config;
    config.rooms = rooms;
    const simulation::Building building = simulation::make_building(config);
    const simulation::World world(building);
    const auto way = simulation::drive(simulation::plan_tour(building, {}), {});
    for (double t_s = 0.0; t_s < way.duration_s(); t_s += kPeriod_us * 1e-6) {
      poses.push_back(way.at(t_s));
      clouds.push_back(
          scan_sphere(world, poses.back(), {.rays = rays, .height_m = 0.8, .range_sd_m = 0.0}, 1));
    }
  }

  std::vector<Pose2> poses;
  std::vector<Cloud> clouds;
};

Cloud with_noise(Cloud cloud, simulation::Random& random) {
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f way = (cloud.points[i] - cloud.origins[i]).normalized();
    cloud.points[i] += static_cast<float>(kNoise_m * random.normal()) * way;
  }
  return cloud;
}

struct Driver {
  Driver() {
    bus.subscribe(bus::kLocalisation, [this](const localisation_t& m) { take(m); });
  }

  void take(const localisation_t& message) {
    if (message.utime != utime_us) return;
    is_answered = true;
    tracking += message.state == localisation_t::STATE_TRACKING;
  }

  void drive(const Pose2& T_odom_base, Cloud cloud) {
    utime_us = cloud.utime_us = kBegin_us + clouds++ * kPeriod_us;
    is_answered = false;
    bus.publish(bus::kOdometry, bus::to_message(StampedPose2{utime_us, T_odom_base}));
    bus.publish(bus::kCloud, bus::to_message(cloud, "base", static_cast<std::int32_t>(clouds)));
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
    while (!is_answered && std::chrono::steady_clock::now() < end)
      bus.handle(std::chrono::milliseconds(20));
  }

  bus::Bus bus{bus::BusOptions{}};
  std::int64_t utime_us = 0, clouds = 0, tracking = 0;
  bool is_answered = false;
};

int number(char** argv, int argc, int i, int otherwise) {
  return argc > i ? std::atoi(argv[i]) : otherwise;
}

}  // namespace

int main(int argc, char** argv) {
  const int minutes = number(argv, argc, 1, 1);
  const Lap lap(number(argv, argc, 2, 6), number(argv, argc, 3, 6000));
  simulation::Random random(1);
  Driver driver;
  for (int i = 0; i < minutes * 600; ++i) {
    const std::size_t at = static_cast<std::size_t>(i) % lap.poses.size();
    driver.drive(lap.poses[at], with_noise(lap.clouds[at], random));
    if (driver.clouds % 600 == 0)
      std::cout << driver.clouds / 600 << ' ' << driver.clouds << ' ' << driver.tracking
                << std::endl;
  }
  return 0;
}
