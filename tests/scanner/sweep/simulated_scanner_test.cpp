// The assembler at work on the simulator's scanner: its plate has edges and arms, its robot a body,
// its ranges are whole millimetres, and its physics knows nothing of the assembler's formulas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "voxlist/scanner/sweep/cloud_assembler.h"
#include "voxlist/simulation/scanner/mirror_scanner.h"

namespace voxlist::scanner {
namespace {

constexpr double kPi = std::numbers::pi;

simulation::MirrorScannerConfig quiet_scanner() {
  simulation::MirrorScannerConfig config;
  config.range_sd_m = 0.0;
  return config;
}

std::vector<double> boxes_around(const std::vector<simulation::Box>& body) {
  std::vector<double> limits;
  for (const simulation::Box& box : body)
    for (int axis = 0; axis < 3; ++axis) {
      limits.push_back(box.centre_m[axis] - box.half_m[axis] - 0.02);
      limits.push_back(box.centre_m[axis] + box.half_m[axis] + 0.02);
    }
  return limits;
}

struct Simulation {
  Simulation(const simulation::MirrorScannerConfig& config, std::vector<Pose2> poses)
      : world(simulation::make_building({})),
        truth(0.02, std::move(poses)),
        scanner(world, truth, config, 1),
        assembler(settings(config)) {}

  static CloudAssemblerConfig settings(const simulation::MirrorScannerConfig& config) {
    CloudAssemblerConfig settings;
    settings.robot_boxes_m = boxes_around(config.body);
    return settings;
  }

  // The state at the last edge before a time.
  MirrorState mirror(std::int64_t utime_us) const {
    const double step_s = scanner.motor().edge_s(1) - scanner.motor().edge_s(0);
    const auto edge = std::llround(std::floor(static_cast<double>(utime_us) * 1e-6 / step_s));
    MirrorState state;
    state.utime_us = std::llround(scanner.motor().edge_s(edge) * 1e6);
    state.state = MirrorState::State::kLocked;
    state.angle_known = true;
    state.step_rad = scanner.motor().step_rad();
    const double turn_rad = 2.0 * kPi;
    const double angle_rad = scanner.motor().angle_rad(scanner.motor().edge_s(edge) + 1e-7);
    state.angle_rad = angle_rad - turn_rad * std::floor(angle_rad / turn_rad);
    state.rate_radps = state.step_rad / step_s;
    return state;
  }

  void run(double duration_s) {
    std::int64_t odometry_us = 0;
    const double period_us = 1e6 / scanner.config().turns_per_second;
    for (int i = 0; i < static_cast<int>(duration_s * 75.0); ++i) {
      const std::int64_t utime_us = 100'000 + std::llround(i * period_us);
      for (; odometry_us <= utime_us; odometry_us += 20'000)
        take(assembler.add_odometry(
            {odometry_us, truth.at(static_cast<double>(odometry_us) * 1e-6)}));
      take(assembler.add_mirror(mirror(utime_us)));
      take(assembler.add_line(scanner.measure(utime_us)));
    }
  }

  void take(const Assembly& made) {
    clouds.insert(clouds.end(), made.clouds.begin(), made.clouds.end());
    for (const auto& [what, times] : by_counter_name(made.counts)) counts[what] += times;
  }

  std::vector<double> errors_m(const Cloud& cloud) const {
    const Pose2 T_map_base = truth.at(static_cast<double>(cloud.utime_us) * 1e-6);
    std::vector<double> errors;
    for (const auto& point : cloud.points) {
      const Eigen::Vector3d p = T_map_base * point.cast<double>();
      double nearest_m = 1e9;
      for (const simulation::Box& box : world.building().solid.boxes())
        nearest_m = std::min(nearest_m, box.surface_distance_m(p));
      errors.push_back(nearest_m);
    }
    return errors;
  }

  const simulation::World world;
  const simulation::Trajectory truth;
  const simulation::MirrorScanner scanner;
  CloudAssembler assembler;
  std::vector<Cloud> clouds;
  std::map<std::string, std::int64_t> counts;
};

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(SimulatedScanner, StandingSeesTheBuildingAndNeitherItselfNorItsArms) {
  Simulation simulation(quiet_scanner(), {{2.0, 0.0, 0.7}});
  simulation.run(3.2);
  ASSERT_EQ(simulation.clouds.size(), 3u);
  const std::vector<double> errors = simulation.errors_m(simulation.clouds[1]);
  EXPECT_GT(errors.size(), 5'000u);
  EXPECT_LT(rms(errors), 0.001);
  EXPECT_LT(std::ranges::max(errors), 0.005) << "a point that nothing in the building made";
  EXPECT_GT(simulation.counts["beams/before_mirror"], 100);
  EXPECT_GT(simulation.counts["beams/robot"], 10) << "most of it is too near already";
  EXPECT_GT(simulation.counts["beams/too_near"], 1'000);
}

TEST(SimulatedScanner, DrivingAndTurningSeesItWithinFiveMillimetres) {
  std::vector<Pose2> poses;
  for (int i = 0; i < 200; ++i) {  // 0.5 m/s, 45 deg/s
    const double yaw_rad = kPi / 4.0 * 0.02 * i, radius_m = 0.5 / (kPi / 4.0);
    poses.push_back({2.0 + radius_m * std::sin(yaw_rad), -radius_m * std::cos(yaw_rad) + 0.4,
                     wrap_angle(yaw_rad)});
  }
  Simulation simulation(quiet_scanner(), poses);
  simulation.run(3.2);
  ASSERT_EQ(simulation.clouds.size(), 3u);
  for (const Cloud& cloud : simulation.clouds) EXPECT_LT(rms(simulation.errors_m(cloud)), 0.005);
}

}  // namespace
}  // namespace voxlist::scanner
