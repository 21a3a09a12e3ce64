#include "voxlist/simulation/building/objects.h"

#include <algorithm>
#include <numbers>
#include <optional>

#include "voxlist/simulation/random.h"

namespace voxlist::simulation {
namespace {

// Places that are tried for each object before a room counts as full.
constexpr int kTries = 200;

Box draw(const Room& room, Random& random) {
  const double x = random.uniform(room.low.x(), room.high.x());
  const double y = random.uniform(room.low.y(), room.high.y());
  const double length = random.uniform(0.2, 0.4), width = random.uniform(0.2, 0.4);
  const double height = random.uniform(0.3, 0.7);
  return standing({x, y}, {length, width, height}, random.uniform(0.0, std::numbers::pi));
}

bool touches(const Furniture& piece, const Rectangle& print) {
  return std::any_of(piece.boxes.begin(), piece.boxes.end(),
                     [&](const Box& box) { return footprint(box).overlaps(print); });
}

std::optional<Box> find_place(const FloorPlan& plan, const std::vector<Furniture>& furniture,
                              const Room& room, Random& random) {
  for (int i = 0; i < kTries; ++i) {
    const Box box = draw(room, random);
    const Rectangle print = footprint(box);
    if (plan.leaves_room_for(box, {room.low, room.high}) &&
        std::none_of(furniture.begin(), furniture.end(),
                     [&](const Furniture& piece) { return touches(piece, print); }))
      return box;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Box> place_objects(const FloorPlan& plan, const std::vector<Furniture>& furniture,
                               int per_room, Random& random) {
  std::vector<Box> objects;
  for (const Room& room : plan.rooms)
    for (int i = 0; i < per_room; ++i)
      if (const auto box = find_place(plan, furniture, room, random)) objects.push_back(*box);
  return objects;
}

}  // namespace voxlist::simulation
