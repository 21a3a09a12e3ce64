#include "voxlist/simulation/building/floor_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "voxlist/geometry/elementary.h"
#include "voxlist/simulation/random.h"

namespace voxlist::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Metres: from the origin to the corridor's end behind it, and doors as buildings have them.
constexpr double kBehindStart = 1.0;
constexpr double kDoorWidth = 1.0;
constexpr double kDoorHeight = 2.1;
constexpr double kDoorFromCorner = 0.8;

class Planner {
 public:
  Planner(const BuildingConfig& config, Random& random)
      : config_(config),
        random_(random),
        low_(-kBehindStart, -config.depth_m / 2.0),
        high_(config.length_m - kBehindStart, config.depth_m / 2.0) {
    plan_.inside = {low_, high_};
  }

  FloorPlan make() {
    add_shell();
    add_side(+1.0, (config_.rooms + 1) / 2);
    add_side(-1.0, config_.rooms / 2);
    mark_ways();
    return std::move(plan_);
  }

 private:
  void add_wall(double x0, double y0, double x1, double y1, double from_m = 0.0) {
    plan_.boxes.push_back(
        block({x0, std::min(y0, y1), from_m}, {x1, std::max(y0, y1), config_.height_m}));
  }

  void add_shell() {
    const Vector2d out_low = low_.array() - kWall_m, out_high = high_.array() + kWall_m;
    const double height = config_.height_m;
    plan_.boxes.push_back(
        block({out_low.x(), out_low.y(), -kWall_m}, {out_high.x(), out_high.y(), 0.0}));
    plan_.boxes.push_back(
        block({out_low.x(), out_low.y(), height}, {out_high.x(), out_high.y(), height + kWall_m}));
    add_wall(out_low.x(), out_low.y(), low_.x(), out_high.y());
    add_wall(high_.x(), out_low.y(), out_high.x(), out_high.y());
    add_wall(low_.x(), out_low.y(), high_.x(), low_.y());
    add_wall(low_.x(), high_.y(), high_.x(), out_high.y());
  }

  // The rooms of one side of the corridor: +1 left (y > 0), -1 right.
  void add_side(double side, int count) {
    const double corridor = side * config_.corridor_width_m / 2.0;
    if (count == 0) return add_wall(low_.x(), corridor, high_.x(), corridor + side * kWall_m);
    double from = low_.x();
    for (int i = 0; i < count; ++i) {
      const double to = room_end(from, i, count);
      add_room(side, from, to);
      if (i + 1 < count) add_wall(to, corridor, to + kWall_m, side * high_.y());
      from = to + kWall_m;
    }
  }

  // Where room i of `count`, which begins at `from`, ends.
  double room_end(double from, int i, int count) {
    if (i + 1 == count) return high_.x();
    if (config_.alike != 0) return from + (config_.length_m - (count - 1) * kWall_m) / count;
    return low_.x() + config_.length_m / count * (i + 1 + random_.uniform(-0.1, 0.1));
  }

  // The place of a room's door. In rooms that are alike it is where the first one has it, seen from
  // the corridor.
  double door_between(double side, double x0, double x1) {
    if (config_.alike == 0 || plan_.rooms.empty())
      return random_.uniform(x0 + kDoorFromCorner, x1 - kDoorFromCorner);
    const double into = plan_.rooms.front().door.x() - plan_.rooms.front().low.x();
    return side > 0.0 ? x0 + into : x1 - into;
  }

  void add_room(double side, double x0, double x1) {
    const double corridor = side * config_.corridor_width_m / 2.0;
    const double inner = corridor + side * kWall_m, outer = side * high_.y();
    const double door = door_between(side, x0, x1);
    const double door0 = door - kDoorWidth / 2.0, door1 = door + kDoorWidth / 2.0;
    add_wall(x0, corridor, door0, inner);
    add_wall(door1, corridor, x1, inner);
    add_wall(door0, corridor, door1, inner, kDoorHeight);
    plan_.rooms.push_back({{x0, std::min(inner, outer)},
                           {x1, std::max(inner, outer)},
                           {door, corridor + side * kWall_m / 2.0}});
  }

  void mark_ways() {
    mark_way({0.0, 0.0}, {high_.x() - kWayHalfWidth_m, 0.0});
    for (const Room& room : plan_.rooms) {
      const double in = room.door.y() + std::copysign(kWayHalfWidth_m, room.door.y());
      mark_way({room.door.x(), 0.0}, {room.door.x(), in});
      mark_way({room.door.x(), in}, room.centre());
    }
  }

  void mark_way(const Vector2d& from, const Vector2d& to) {
    const int steps = 1 + static_cast<int>((to - from).norm() / 0.1);
    for (int i = 0; i <= steps; ++i) plan_.ways.push_back(from + (to - from) * i / steps);
  }

  const BuildingConfig& config_;
  Random& random_;
  const Vector2d low_, high_;
  FloorPlan plan_;
};

}  // namespace

bool FloorPlan::leaves_room_for(const Box& box, const Rectangle& region) const {
  constexpr double kSlack = 1e-9;
  const Rectangle print = footprint(box);
  return (print.low.array() > region.low.array() - kSlack).all() &&
         (print.high.array() < region.high.array() + kSlack).all() &&
         std::none_of(holes.begin(), holes.end(),
                      [&](const Rectangle& hole) { return hole.overlaps(print); }) &&
         std::all_of(ways.begin(), ways.end(), [&box](const Vector2d& point) {
           return box.distance_m(point) >= kWayHalfWidth_m;
         });
}

Box block(const Vector3d& low, const Vector3d& high) {
  return {(low + high) / 2.0, (high - low) / 2.0, 0.0};
}

Box standing(const Vector2d& centre, const Vector3d& size, double yaw_rad) {
  return {{centre.x(), centre.y(), size.z() / 2.0}, size / 2.0, yaw_rad};
}

Rectangle footprint(const Box& box) {
  const auto [sine, cosine] = elementary::sine_cosine(box.yaw_rad);
  const double c = std::abs(cosine), s = std::abs(sine);
  const Vector2d half{c * box.half_m.x() + s * box.half_m.y(),
                      s * box.half_m.x() + c * box.half_m.y()};
  const Vector2d centre = box.centre_m.head<2>();
  return {centre - half, centre + half};
}

FloorPlan make_floor_plan(const BuildingConfig& config, Random& random) {
  return Planner(config, random).make();
}

}  // namespace voxlist::simulation
