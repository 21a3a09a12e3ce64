#include "tests/bench/drives/worlds.h"

#include <utility>
#include <vector>

#include "voxlist/simulation/building/floor_plan.h"
#include "voxlist/simulation/random.h"

namespace voxlist::bench {
namespace {

using simulation::block;
using simulation::standing;

constexpr double kStreet_m = 120.0;

simulation::BuildingConfig corridor(int rooms, int seed) {
  simulation::BuildingConfig config;
  config.length_m = 200.0;
  config.rooms = rooms;
  config.furniture_per_room = 0;
  config.seed = seed;
  return config;
}

// One side of the street: +1 left, -1 right.
void add_houses(double side, simulation::Random& random, std::vector<simulation::Box>& boxes) {
  for (double x = 0.0; x < kStreet_m;) {
    const double front = random.uniform(6.0, 9.0), length = random.uniform(6.0, 14.0);
    const double high = random.uniform(4.0, 10.0);
    boxes.push_back(standing({x + length / 2.0, side * (front + 4.0)}, {length, 8.0, high}));
    x += length + random.uniform(0.0, 3.0);
  }
}

void add_kerb(double side, simulation::Random& random, std::vector<simulation::Box>& boxes) {
  for (double x = random.uniform(0.0, 8.0); x < kStreet_m; x += random.uniform(5.0, 15.0)) {
    boxes.push_back(standing({x, side * random.uniform(3.4, 3.8)}, {4.2, 1.8, 1.5},
                             random.uniform(-0.05, 0.05)));
    boxes.push_back(standing({x + random.uniform(2.5, 4.5), side * 5.0}, {0.25, 0.25, 5.0}));
  }
}

}  // namespace

simulation::Building bare_corridor() { return simulation::make_building(corridor(0, 1)); }

simulation::Building corridor_with_doors(int seed) {
  return simulation::make_building(corridor(60, seed));
}

simulation::Building street(int seed) {
  simulation::Random random(static_cast<std::uint64_t>(seed), 31);
  std::vector<simulation::Box> boxes{block({-50.0, -50.0, -0.2}, {kStreet_m + 50.0, 50.0, 0.0})};
  for (const double side : {1.0, -1.0}) {
    add_houses(side, random, boxes);
    add_kerb(side, random, boxes);
  }
  return {simulation::BoxTree(std::move(boxes)), {}, {}};
}

}  // namespace voxlist::bench
