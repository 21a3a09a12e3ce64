#include "tests/bench/ramps/two_floors.h"

#include <algorithm>
#include <cmath>

#include "tests/bench/ramps/slabs.h"
#include "voxlist/simulation/random.h"

namespace voxlist::bench {
namespace {

constexpr double kUpper_m = 3.0;
// The rooms reach from -kX_m to kX_m, and from -kY_m to kY_m; each flight of the ramp is kLane_m
// wide and begins kX_m + kFlat_m to the east, the landing kLanding_m long.
constexpr double kX_m = 7.0, kY_m = 5.0, kWall_m = 0.1, kLane_m = 2.4, kFlat_m = 1.0,
                 kLanding_m = 3.0, kCeiling_m = 2.6;

// Walls, furniture along them, and the ceiling of a room on a floor; its door is in the east, from
// door_y on.
void add_room(double floor_m, double door_y, simulation::Random random, std::vector<Slab>& slabs) {
  const double top = floor_m + kCeiling_m;
  const auto add = [&](double x0, double y0, double x1, double y1, double z0, double z1) {
    slabs.push_back(block({x0, y0, floor_m + z0}, {x1, y1, floor_m + z1}));
  };
  slabs.push_back(block({-kX_m, -kY_m, floor_m - 0.2}, {kX_m, kY_m, floor_m}));
  slabs.push_back(block({-kX_m, -kY_m, top}, {kX_m, kY_m, top + 0.1}));
  add(-kX_m - kWall_m, -kY_m, -kX_m, kY_m, 0.0, kCeiling_m);
  add(-kX_m, -kY_m - kWall_m, kX_m, -kY_m, 0.0, kCeiling_m);
  add(-kX_m, kY_m, kX_m, kY_m + kWall_m, 0.0, kCeiling_m);
  add(kX_m, -kY_m, kX_m + kWall_m, door_y, 0.0, kCeiling_m);
  add(kX_m, door_y + kLane_m, kX_m + kWall_m, kY_m, 0.0, kCeiling_m);
  for (int i = 0; i < 14; ++i) {
    const double length = random.uniform(0.4, 1.6), deep = random.uniform(0.3, 0.7),
                 high = random.uniform(0.4, 2.0), x = random.uniform(-kX_m + 1.0, kX_m - 2.6);
    const bool north = i % 2 == 0;
    add(x, north ? kY_m - deep : -kY_m, x + length, north ? kY_m : -kY_m + deep, 0.0, high);
  }
  for (int i = 0; i < 3; ++i) {
    const double deep = random.uniform(0.3, 0.7), y = random.uniform(-3.5, 2.5);
    add(-kX_m, y, -kX_m + deep, y + random.uniform(0.4, 1.0), 0.0, random.uniform(0.4, 2.0));
  }
}

std::vector<Slab> slabs_of(const TwoFloorsConfig& config, double flight_m, double upper_m) {
  std::vector<Slab> slabs;
  const double start = kX_m + kFlat_m, end = start + flight_m, far = end + kLanding_m,
               half = 0.5 * upper_m;
  add_room(0.0, -kLane_m, simulation::Random(config.seed), slabs);
  add_room(upper_m, 0.0, simulation::Random(config.seed + 1000), slabs);
  slabs.push_back(block({kX_m, -kLane_m, -0.2}, {start, 0.0, 0.0}));
  slabs.push_back(flight(start, end, -kLane_m, 0.0, 0.0, half));
  slabs.push_back(block({end, -kLane_m, half - 0.2}, {far, kLane_m, half}));
  slabs.push_back(flight(start, end, 0.0, kLane_m, upper_m, half));
  slabs.push_back(block({kX_m, 0.0, upper_m - 0.2}, {start, kLane_m, upper_m}));
  const double top = upper_m + kCeiling_m;
  slabs.push_back(block({kX_m, -kLane_m - kWall_m, -0.2}, {far, -kLane_m, top}));
  slabs.push_back(block({kX_m, kLane_m, -0.2}, {far, kLane_m + kWall_m, top}));
  slabs.push_back(block({far, -kLane_m, -0.2}, {far + kWall_m, kLane_m, top}));
  slabs.push_back(block({start, -0.05, -0.2}, {end, 0.05, top}));
  simulation::Random random(config.seed + 7);
  for (int i = 0; i < 8; ++i) {  // pipes and boxes on the ramp's walls
    const double x = random.uniform(start, far - 1.0), z = random.uniform(0.5, upper_m);
    const double y = i % 2 == 0 ? kLane_m - 0.15 : -kLane_m;
    slabs.push_back(block({x, y, z}, {x + random.uniform(0.2, 0.8), y + 0.15, z + 0.5}));
  }
  return slabs;
}

}  // namespace

TwoFloors::TwoFloors(const TwoFloorsConfig& config)
    : upper_m_(kUpper_m),
      flight_m_(0.5 * kUpper_m / std::tan(config.slope_rad)),
      world_(slabs_of(config, flight_m_, upper_m_)) {}

Pose3 TwoFloors::standing(const Pose2& place, double above_m) const {
  return bench::standing(world_, place, above_m);
}

std::vector<Pose3> TwoFloors::drive(double step_m) const {
  const double end = kX_m + kFlat_m + flight_m_ + 0.5 * kLanding_m, lane = 0.5 * kLane_m, low = 1.2,
               high = upper_m_ + 1.2, half = 0.5 * upper_m_ + 1.2;
  const std::vector<Stop> up = {{{0.0, 0.0}, low},    {{-4.5, 1.5}, low},   {{-4.0, -2.5}, low},
                                {{3.0, -2.8}, low},   {{4.0, 2.5}, low},    {{5.5, -lane}, low},
                                {{end, -lane}, half}, {{end, lane}, half},  {{5.5, lane}, high},
                                {{3.0, -2.8}, high},  {{-4.0, -2.5}, high}, {{-4.5, 2.0}, high},
                                {{3.0, 2.5}, high}};
  std::vector<Stop> way = up;
  way.insert(way.end(), {{{5.5, lane}, high}, {{end, lane}, half}, {{end, -lane}, half}});
  way.insert(way.end(), {{{5.5, -lane}, low}, {{0.0, 0.0}, low}});
  return drive_along(world_, way, step_m);
}

}  // namespace voxlist::bench
