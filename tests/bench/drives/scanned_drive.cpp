#include "tests/bench/drives/scanned_drive.h"

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>

#include "tests/bench/drives/worlds.h"
#include "tests/bench/test_drive.h"
#include "voxlist/simulation/world/robot.h"

namespace voxlist::bench {
namespace {

constexpr std::int64_t kStep_us = 1'000'000;
constexpr int kRaysInARing = 360;
constexpr double kShortReturns = 0.05;
// The first scan that may be bad, or before which the robot is carried away.
constexpr std::size_t kSettled = 3;
// Wheels that slip measure every fifth step too long by this share: where walls can tell, and where
// nothing can.
constexpr int kSlipsEvery = 5;
constexpr double kSlip = 0.5, kUnseenSlip = 0.1;
// A robot that drives straight on is off its line by so much (m, rad), as a standard deviation.
constexpr double kWeave_m = 0.05, kWeave_rad = 0.02;
// Added to a drive's number for one elsewhere in its world.
constexpr std::uint64_t kElsewhere = 500'001;
constexpr double kCorridorFrom_m = 90.0, kStreetFrom_m = 40.0;

simulation::SphereScanConfig rings(int count, double to_deg, double range_m, double height_m) {
  return {.rays = count * kRaysInARing,
          .rings = count,
          .rings_to_deg = to_deg,
          .height_m = height_m,
          .range_max_m = range_m};
}

simulation::SphereScanConfig config_of(const DriveSpec& spec) {
  const bool outdoors = spec.place == Place::kStreet;
  const double height_m = outdoors ? 1.8 : 1.0, range_m = outdoors ? 60.0 : 30.0;
  switch (spec.laser) {
    case Laser::k16Rings:
      return rings(16, 15.0, range_m, height_m);
    case Laser::k25Rings:
      return rings(25, 25.0, range_m, height_m);
    case Laser::k49Rings:
      return rings(49, 25.0, outdoors ? range_m : 8.0, height_m);
    case Laser::kMirror:
    case Laser::k64000Rays:
      break;
  }
  return {.height_m = height_m};
}

std::vector<Pose2> straight_on(const DriveSpec& spec, simulation::Random& random) {
  const double from = spec.place == Place::kStreet ? kStreetFrom_m : kCorridorFrom_m;
  const double start = from + random.uniform(0.0, 5.0);
  std::vector<Pose2> poses;
  for (int i = 0; i < spec.scans; ++i) {
    const double y = kWeave_m * random.normal();
    poses.push_back({start + i * spec.step_m, y, kWeave_rad * random.normal()});
  }
  return poses;
}

simulation::Building world_of(const DriveSpec& spec, int seed) {
  if (spec.place == Place::kStreet) return street(seed);
  return spec.place == Place::kBareCorridor ? bare_corridor() : corridor_with_doors(seed);
}

std::vector<ScannedStep> on_a_line(const DriveSpec& spec, int seed, std::uint64_t noise) {
  simulation::Random random(noise, 41);
  const simulation::World world(world_of(spec, seed));
  const std::vector<Pose2> poses = straight_on(spec, random);
  const simulation::Trajectory wheels =
      simulation::wheel_odometry(simulation::Trajectory(1.0, poses), {}, noise);
  std::vector<ScannedStep> steps;
  for (std::size_t i = 0; i < poses.size(); ++i)
    steps.push_back({spec.laser == Laser::kMirror
                         ? scan_at(world.building(), poses[i], 0, 1000 * noise + i)
                         : scan_sphere(world, poses[i], config_of(spec), 1000 * noise + i),
                     poses[i], wheels.at(static_cast<double>(i))});
  return steps;
}

// What slipping wheels measure, from what sound ones do.
void let_slip(std::vector<ScannedStep>& steps, double slip) {
  Pose2 last = *steps.front().T_odom_base, T_slipped = last;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const Pose2 now = *steps[i].T_odom_base, step = last.inverse() * now;
    T_slipped = T_slipped * part_of(step, i % kSlipsEvery == 0 ? 1.0 + slip : 1.0);
    last = now;
    steps[i].T_odom_base = T_slipped;
  }
}

void measure(const DriveSpec& spec, std::vector<ScannedStep>& steps) {
  if (spec.wheels == Wheels::kSlipping)
    let_slip(steps, spec.place == Place::kBareCorridor ? kUnseenSlip : kSlip);
  for (ScannedStep& step : steps) {
    if (spec.wheels == Wheels::kExact) step.T_odom_base = step.truth;
    if (spec.wheels == Wheels::kNone) step.T_odom_base.reset();
  }
}

void spoil(const DriveSpec& spec, std::vector<ScannedStep>& steps, const Cloud& other,
           simulation::Random& random) {
  const std::size_t bad = static_cast<unsigned>(spec.bad_scans);
  const std::size_t first = kSettled + random.bits() % (steps.size() - kSettled - bad - 1);
  for (std::size_t i = first; i < first + bad; ++i) {
    steps[i].scan = spoiled(steps[i].scan, spec.bad, other, random);
    steps[i].bad = true;
  }
}

// What a robot goes on with that was carried away: the wheels measure no jump.
void carry(std::vector<ScannedStep>& steps, const std::vector<ScannedStep>& elsewhere) {
  const std::optional<Pose2> T_last = steps[kSettled - 1].T_odom_base;
  steps.resize(kSettled);
  const std::optional<Pose2> T_first = elsewhere.front().T_odom_base;
  for (ScannedStep step : elsewhere) {
    if (T_last) step.T_odom_base = *T_last * T_first->inverse() * *step.T_odom_base;
    step.carried = steps.size() == kSettled;
    steps.push_back(std::move(step));
  }
}

TestFloor bare_floor(int seed) {
  const TestFloorConfig config = floor_16_13(seed);
  return {config.name, config, simulation::make_building(config.wing), {}, {}, {}};
}

std::vector<ScannedStep> on_floor(const DriveSpec& spec, int seed, std::uint64_t noise) {
  const TestFloor floor = bare_floor(seed);
  const simulation::Building now =
      spec.mapped && spec.changed ? later(floor.config) : floor.building;
  const simulation::World world(now);
  simulation::Random random(noise, 43);
  std::vector<ScannedStep> steps;
  for (DriveStep& step :
       drive_through(floor, now, static_cast<DriveKind>(noise % 3), spec.changed ? 3 : 0, noise)) {
    if (std::ssize(steps) == spec.scans) break;
    if (spec.laser != Laser::kMirror)
      step.scan = scan_sphere(world, step.truth, config_of(spec), 1000 * noise + steps.size());
    if (spec.changed) step.scan = with_short_returns(std::move(step.scan), kShortReturns, random);
    steps.push_back({std::move(step.scan), step.truth, step.T_odom_base});
  }
  return steps;
}

}  // namespace

std::vector<ScannedStep> scanned_drive(const DriveSpec& spec, int seed, int i) {
  const auto noise = static_cast<std::uint64_t>(1000 * seed + i);
  const auto drive = [&](std::uint64_t number) {
    return spec.place == Place::kFloor ? on_floor(spec, seed, number)
                                       : on_a_line(spec, seed, number);
  };
  std::vector<ScannedStep> steps = drive(noise);
  simulation::Random random(noise, 42);
  if (spec.carried) carry(steps, drive(noise + kElsewhere));
  if (spec.bad != Bad::kNot) spoil(spec, steps, drive(noise + kElsewhere).front().scan, random);
  measure(spec, steps);
  for (std::size_t k = 0; k < steps.size(); ++k)
    steps[k].scan.utime_us = static_cast<std::int64_t>(k + 1) * kStep_us;
  return steps;
}

}  // namespace voxlist::bench
