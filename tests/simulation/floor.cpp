#include "tests/simulation/floor.h"

#include <utility>

#include "voxlist/simulation/building/floor_plan.h"

namespace voxlist::simulation {

double wing_pitch_m(const BuildingConfig& wing) { return wing.depth_m + kWall_m; }

Building make_floor(const BuildingConfig& wing, int wings) {
  std::vector<Box> boxes;
  std::vector<Room> rooms;
  for (int i = 0; i < wings; ++i) {
    BuildingConfig config = wing;
    config.seed = wing.seed + i;
    const Building one = make_building(config);
    const Eigen::Vector2d shift(0.0, i * wing_pitch_m(wing));
    for (Box box : one.solid.boxes()) {
      box.centre_m.head<2>() += shift;
      boxes.push_back(box);
    }
    for (const Room& room : one.rooms)
      rooms.push_back({room.low + shift, room.high + shift, room.door + shift});
  }
  return {BoxTree(std::move(boxes)), std::move(rooms), {}};
}

}  // namespace voxlist::simulation
