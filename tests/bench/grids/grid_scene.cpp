#include "tests/bench/grids/grid_scene.h"

#include <utility>

#include "tests/bench/ghosts/ghost_drive.h"
#include "tests/bench/test_floor.h"
#include "voxlist/simulation/building/floor_plan.h"
#include "voxlist/simulation/scanner/ideal_sweep.h"

namespace voxlist::bench {
namespace {

constexpr double kScanEvery_s = 1.0;

// A shutter that hangs 0.8 to 1.0 m above the floor, across a room behind its door: a low robot
// passes.
std::vector<simulation::Box> shutters(const simulation::Building& building) {
  std::vector<simulation::Box> boxes;
  for (std::size_t i = 0; i < building.rooms.size(); i += 2) {
    const simulation::Room& room = building.rooms[i];
    const double into = room.centre().y() > room.door.y() ? 1.0 : -1.0;
    const double y = room.door.y() + into * 0.3;
    boxes.push_back(simulation::block({room.door.x() - 0.6, y, 0.8 + 0.1 * static_cast<double>(i)},
                                      {room.door.x() + 0.6, y + 0.03, 2.1}));
  }
  return boxes;
}

simulation::Building plain_building(int seed) {
  TestFloorConfig floor = floor_16_13(seed);
  floor.wing.stairs = 1;
  floor.wing.pipes = 3;
  floor.wing.objects = 3;
  return simulation::make_building(floor.wing);
}

simulation::Building with_shutters(const simulation::Building& plain) {
  std::vector<simulation::Box> boxes = plain.solid.boxes();
  for (const simulation::Box& box : shutters(plain)) boxes.push_back(box);
  return {simulation::BoxTree(std::move(boxes)), plain.rooms, plain.holes};
}

}  // namespace

GridScene grid_scene(int seed) {
  const simulation::Building plain = plain_building(seed);
  const simulation::Building building = with_shutters(plain);
  mapping::MapBuilderConfig config;
  config.count_free = true;
  GridScene scene{building, mapping::MapBuilder(config)};
  const simulation::World world(building);
  const simulation::Trajectory way = lap(plain);  // passes under the shutters
  const simulation::MirrorScanner scanner(world, way, {}, static_cast<std::uint64_t>(seed));
  for (double t = kScanEvery_s; t < way.duration_s(); t += kScanEvery_s) {
    mapping::Keyframe keyframe;
    keyframe.cloud = simulation::scan_sweep(scanner, way, t, {}, static_cast<std::uint64_t>(seed));
    keyframe.T_map_base = to_pose3(way.at(t));
    scene.map.add(std::move(keyframe));
  }
  return scene;
}

}  // namespace voxlist::bench
