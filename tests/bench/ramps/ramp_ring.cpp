#include "tests/bench/ramps/ramp_ring.h"

#include <cmath>

#include "tests/bench/ramps/slabs.h"
#include "voxlist/simulation/random.h"

namespace voxlist::bench {
namespace {

// The ring's outer walls stand at 0 and kX_m, 0 and kY_m; the corridor is kLane_m wide. The floor
// of the north side begins to rise, and is level again, kFlat_m from the corners.
constexpr double kX_m = 46.0, kY_m = 12.0, kLane_m = 2.6, kFlat_m = 6.0, kWall_m = 0.1;
constexpr double kUp_m = 1.2, kTop_m = kUp_m + 2.6;

// Things along the corridor's walls: shelves, boxes, pillars. Not where the drive goes.
void furnish(simulation::Random random, std::vector<Slab>& slabs) {
  for (int i = 0; i < 60; ++i) {
    const bool north = i % 2 == 0, outer = i % 4 < 2;
    const double length = random.uniform(0.2, 1.6), deep = random.uniform(0.1, 0.45),
                 x = random.uniform(0.3, kX_m - 2.0), low = random.uniform(-0.5, 1.5),
                 high = low + random.uniform(0.3, 2.0);
    const double inner = north ? kY_m - kLane_m : kLane_m;
    const double wall = outer ? (north ? kY_m : 0.0) : inner;
    const bool towards_south = north == outer;
    slabs.push_back(block({x, towards_south ? wall - deep : wall, low},
                          {x + length, towards_south ? wall : wall + deep, high}));
  }
}

std::vector<Slab> slabs_of(const RampRingConfig& config) {
  std::vector<Slab> slabs;
  const double run = kUp_m / std::tan(config.slope_rad), north = kY_m - kLane_m,
               west = kFlat_m + run, east = kX_m - kFlat_m - run;
  const auto wall = [&](double x0, double y0, double x1, double y1) {
    slabs.push_back(block({x0, y0, -0.2}, {x1, y1, kTop_m}));
  };
  const auto floor = [&](double x0, double y0, double x1, double y1, double z) {
    slabs.push_back(block({x0, y0, z - 0.2}, {x1, y1, z}));
  };
  floor(0.0, 0.0, kX_m, kLane_m, 0.0);
  floor(0.0, 0.0, kLane_m, kY_m, 0.0);
  floor(kX_m - kLane_m, 0.0, kX_m, kY_m, 0.0);
  floor(0.0, north, kFlat_m, kY_m, 0.0);
  floor(kX_m - kFlat_m, north, kX_m, kY_m, 0.0);
  slabs.push_back(flight(kFlat_m, west, north, kY_m, 0.0, kUp_m));
  floor(west, north, east, kY_m, kUp_m);
  slabs.push_back(flight(east, kX_m - kFlat_m, north, kY_m, kUp_m, 0.0));
  wall(-kWall_m, 0.0, 0.0, kY_m);
  wall(kX_m, 0.0, kX_m + kWall_m, kY_m);
  wall(0.0, -kWall_m, kX_m, 0.0);
  wall(0.0, kY_m, kX_m, kY_m + kWall_m);
  wall(kLane_m, kLane_m, kX_m - kLane_m, north);
  slabs.push_back(block({0.0, 0.0, kTop_m}, {kX_m, kY_m, kTop_m + 0.1}));
  furnish(simulation::Random(config.seed), slabs);
  return slabs;
}

}  // namespace

RampRing::RampRing(const RampRingConfig& config) : world_(slabs_of(config)) {}

std::vector<Pose3> RampRing::drive(double step_m) const {
  const double lane = 0.5 * kLane_m, far = kX_m - lane, north = kY_m - lane, low = 2.0,
               high = kUp_m + 2.0;
  return drive_along(world_,
                     {{{0.5 * kX_m, lane}, low},
                      {{far, lane}, low},
                      {{far, north}, low},
                      {{kX_m - kFlat_m, north}, low},
                      {{0.5 * kX_m, north}, high},
                      {{kFlat_m, north}, low},
                      {{lane, north}, low},
                      {{lane, lane}, low},
                      {{0.5 * kX_m, lane}, low},
                      {{far - 4.0, lane}, low}},
                     step_m);
}

}  // namespace voxlist::bench
