#include "tests/bench/large/large_floor.h"

#include <cmath>

#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"
#include "voxlist/simulation/building/floor_plan.h"

namespace voxlist::bench {
namespace {

constexpr double kWing_m = 13.5, kRoom_m = 6.0;

}  // namespace

TestFloor large_floor(double length_m, double depth_m, int seed) {
  TestFloorConfig config{"large", {}, static_cast<int>(std::lround(depth_m / kWing_m))};
  config.wing.length_m = length_m;
  config.wing.depth_m = kWing_m;
  config.wing.rooms = 2 * static_cast<int>(std::lround(length_m / kRoom_m));
  config.wing.seed = 1000 * seed;
  const double high_m = (config.wings - 0.5) * kWing_m + simulation::kWall_m * config.wings;
  return {config.name,
          config,
          make_floor(config.wing, config.wings),
          {-1.0, -kWing_m / 2.0},
          {length_m - 1.0, high_m},
          {}};
}

int seed_of(const std::filesystem::path& folder) {
  return static_cast<int>(
      mapping::KeyframeReader(folder / mapping::kKeyframeFile).map_id().value_or(0));
}

}  // namespace voxlist::bench
