#include "tests/bench/obstacles/scenes.h"

#include <cmath>

#include "voxlist/geometry/angle.h"
#include "voxlist/simulation/random.h"

namespace voxlist::bench {
namespace {

using Eigen::Vector3d;

constexpr double kHalfWidth_m = 3.0, kFar_m = 14.0, kThick_m = 0.5, kRamp_rad = 5.0 * kRadPerDeg;
constexpr double kRamp_m = 8.0;

// Floor between two places along x, at a height.
Slab floor(double from_x, double to_x, double top_m, double from_y = -kHalfWidth_m,
           double to_y = kHalfWidth_m) {
  return block({from_x, from_y, top_m - kThick_m}, {to_x, to_y, top_m});
}

std::vector<Slab> walls() {
  return {block({-kFar_m, kHalfWidth_m, -3.0}, {kFar_m, kHalfWidth_m + 0.2, 3.0}),
          block({-kFar_m, -kHalfWidth_m - 0.2, -3.0}, {kFar_m, -kHalfWidth_m, 3.0}),
          block({kFar_m, -kHalfWidth_m, -3.0}, {kFar_m + 0.2, kHalfWidth_m, 3.0}),
          block({-kFar_m - 0.2, -kHalfWidth_m, -3.0}, {-kFar_m, kHalfWidth_m, 3.0})};
}

// A slab turned about the upright (yaw) or the cross axis (slope, upwards) at the origin.
Slab turned(Slab slab, double yaw_rad, double slope_rad) {
  Pose3 turn = Pose3::Identity();
  turn.linear() = rotation(yaw_rad, Vector3d::UnitZ()) * rotation(-slope_rad, Vector3d::UnitY());
  slab.T_map_slab = turn * slab.T_map_slab;
  return slab;
}

void add_hole(simulation::Random& random, std::vector<Slab>& slabs) {
  const double y = random.uniform(-0.25, 0.25), depth_m = random.uniform(0.15, 1.0);
  slabs.push_back(floor(-kFar_m, 0.0, 0.0));
  slabs.push_back(floor(0.3, kFar_m, 0.0));
  slabs.push_back(floor(0.0, 0.3, 0.0, -kHalfWidth_m, y - 0.15));
  slabs.push_back(floor(0.0, 0.3, 0.0, y + 0.15, kHalfWidth_m));
  slabs.push_back(floor(-1.0, 1.0, -depth_m));
}

void add_kerb(simulation::Random& random, std::vector<Slab>& slabs) {
  const double down_m = random.uniform(0.12, 0.2), yaw = random.uniform(-0.43, 0.43);
  slabs.push_back(turned(floor(-2.0 * kFar_m, 0.0, 0.0, -kFar_m, kFar_m), yaw, 0.0));
  slabs.push_back(floor(-1.0 - kFar_m, kFar_m, -down_m));
}

void add_stairs(simulation::Random& random, std::vector<Slab>& slabs) {
  const double rise_m = random.uniform(0.16, 0.19), tread_m = random.uniform(0.26, 0.3);
  slabs.push_back(floor(-kFar_m, 0.0, 0.0));
  for (int step = 1; step <= 8; ++step)
    slabs.push_back(floor((step - 1) * tread_m, step * tread_m, -step * rise_m));
  slabs.push_back(floor(8.0 * tread_m, kFar_m, -8.0 * rise_m));
}

void add_ramp(double slope_rad, std::vector<Slab>& slabs) {
  slabs.push_back(floor(-kFar_m, 0.0, 0.0));
  slabs.push_back(turned(floor(0.0, kRamp_m, 0.0), 0.0, slope_rad));
  const double top_m = kRamp_m * std::sin(slope_rad);
  slabs.push_back(floor(kRamp_m * std::cos(slope_rad), kFar_m, top_m));
}

}  // namespace

std::string name_of(SceneKind kind) {
  constexpr std::array kNames{"flat", "ramp up", "ramp down", "hole", "kerb", "stairs"};
  return kNames[static_cast<std::size_t>(kind)];
}

Slab block(const Vector3d& low, const Vector3d& high) {
  Slab slab;
  slab.T_map_slab.translation() = (low + high) / 2.0;
  slab.half_m = (high - low) / 2.0;
  return slab;
}

SlabWorld flat_with(const std::vector<Slab>& things) {
  std::vector<Slab> slabs = walls();
  slabs.push_back(floor(-kFar_m, kFar_m, 0.0));
  slabs.insert(slabs.end(), things.begin(), things.end());
  return SlabWorld(slabs);
}

Scene make_scene(SceneKind kind, std::uint64_t seed) {
  simulation::Random random(seed, 5);
  std::vector<Slab> slabs = walls();
  switch (kind) {
    case SceneKind::kFlat:
      slabs.push_back(floor(-kFar_m, kFar_m, 0.0));
      break;
    case SceneKind::kRampUp:
      add_ramp(kRamp_rad, slabs);
      break;
    case SceneKind::kRampDown:
      add_ramp(-kRamp_rad, slabs);
      break;
    case SceneKind::kHole:
      add_hole(random, slabs);
      break;
    case SceneKind::kKerb:
      add_kerb(random, slabs);
      break;
    case SceneKind::kStairs:
      add_stairs(random, slabs);
      break;
  }
  return {SlabWorld(slabs)};
}

}  // namespace voxlist::bench
