#include "simulation/floor.h"

#include <utility>

namespace voxlist {

Building make_floor(const BuildingConfig& wing, int wings) {
  constexpr double kSharedWall_m = 0.12;
  std::vector<Box> boxes;
  std::vector<Room> rooms;
  for (int i = 0; i < wings; ++i) {
    BuildingConfig config = wing;
    config.seed = wing.seed + i;
    const Building one = make_building(config);
    const Eigen::Vector2d shift(0.0, i * (wing.depth_m + kSharedWall_m));
    for (Box box : one.solid.boxes()) {
      box.centre_m.head<2>() += shift;
      boxes.push_back(box);
    }
    for (const Room& room : one.rooms)
      rooms.push_back({room.low + shift, room.high + shift, room.door + shift});
  }
  return {BoxTree(std::move(boxes)), std::move(rooms), {}};
}

}  // namespace voxlist
