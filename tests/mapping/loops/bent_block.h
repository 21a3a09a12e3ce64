#pragma once

#include <cmath>
#include <vector>

#include "tests/simulation/sphere_scan.h"
#include "voxlist/simulation/building/floor_plan.h"
#include "voxlist/simulation/random.h"
#include "voxlist/simulation/world/world.h"

/// A street round a block of houses, and a drive on it.
namespace voxlist::mapping {

inline constexpr double kLong_m = 30.0, kWide_m = 20.0, kStep_m = 2.0;

// Houses all round a street 6 m wide, of which none stands quite as the next one.
inline simulation::World block() {
  simulation::Random random(7);
  std::vector<simulation::Box> boxes{
      simulation::block({-20.0, -20.0, -0.2}, {kLong_m + 20.0, kWide_m + 20.0, 0.0})};
  const auto house = [&](double x, double y, double side) {
    boxes.push_back(simulation::standing({x, y}, {side, side, random.uniform(3.0, 8.0)},
                                         random.uniform(-0.1, 0.1)));
  };
  for (double x = 5.0; x < kLong_m - 4.0; x += random.uniform(4.0, 6.0)) {
    house(x, 5.0, random.uniform(3.0, 4.5));
    house(x, kWide_m - 5.0, random.uniform(3.0, 4.5));
  }
  for (double x = -6.0; x < kLong_m + 6.0; x += random.uniform(4.0, 6.0)) {
    house(x, -6.0, random.uniform(4.0, 6.0));
    house(x, kWide_m + 6.0, random.uniform(4.0, 6.0));
  }
  for (double y = 0.0; y < kWide_m; y += random.uniform(4.0, 6.0)) {
    house(-6.0, y, random.uniform(4.0, 6.0));
    house(kLong_m + 6.0, y, random.uniform(4.0, 6.0));
  }
  return simulation::World({simulation::BoxTree(std::move(boxes)), {}, {}});
}

// Once round, and on over the first `again_m` of the way.
inline std::vector<Pose2> way_round(double again_m) {
  std::vector<Pose2> poses;
  const double sides_m[] = {kLong_m, kWide_m, kLong_m, kWide_m, again_m};
  Pose2 corner;
  for (const double side_m : sides_m) {
    for (double along_m = 0.0; along_m < side_m; along_m += kStep_m)
      poses.push_back(corner * Pose2{along_m, 0.0, 0.0});
    corner = corner * Pose2{side_m, 0.0, M_PI / 2};
  }
  return poses;
}

// As a drive has it that turns a little too far at each step.
inline std::vector<Pose2> bent(const std::vector<Pose2>& truth) {
  std::vector<Pose2> poses{truth.front()};
  for (std::size_t i = 1; i < truth.size(); ++i)
    poses.push_back(poses.back() * truth[i - 1].inverse() * truth[i] * Pose2{0.0, 0.0, 0.001});
  return poses;
}

// What a laser of 32 rings sees from a pose.
inline Cloud scan_block(const Pose2& pose, std::uint64_t seed, double range_m = 25.0) {
  static const simulation::World world = block();
  return simulation::scan_sphere(world, pose,
                                 {.rays = 32 * 180,
                                  .rings = 32,
                                  .rings_to_deg = 25.0,
                                  .height_m = 1.5,
                                  .range_max_m = range_m},
                                 seed);
}

}  // namespace voxlist::mapping
