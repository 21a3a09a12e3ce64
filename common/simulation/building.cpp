#include "simulation/building.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "simulation/random.h"

namespace voxlist {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kWall = 0.12;
constexpr double kBehindStart = 1.0;  // from the origin to the corridor's end
constexpr double kRoomMin = 2.4;
constexpr double kDoorWidth = 1.0;
constexpr double kDoorHeight = 2.1;
constexpr double kDoorFromCorner = 0.8;
constexpr double kWayHalfWidth = 0.5;  // kept free of furniture on both sides of every way
constexpr double kTableHeight = 0.74;
constexpr double kTableTop = 0.04;
constexpr double kTableOverhang = 0.15;
constexpr double kTableLeg = 0.05;

Box block(const Vector3d& low, const Vector3d& high) {
  return {(low + high) / 2.0, (high - low) / 2.0, 0.0};
}

// A box standing on the floor.
Box standing(const Vector2d& centre, const Vector3d& size, double yaw_rad = 0.0) {
  return {{centre.x(), centre.y(), size.z() / 2.0}, size / 2.0, yaw_rad};
}

class Builder {
 public:
  explicit Builder(const BuildingConfig& config)
      : config_(config),
        random_(static_cast<std::uint64_t>(config.seed)),
        low_(-kBehindStart, -config.depth_m / 2.0),
        high_(config.length_m - kBehindStart, config.depth_m / 2.0) {}

  Building build() {
    add_shell();
    add_side(+1.0, (config_.rooms + 1) / 2);
    add_side(-1.0, config_.rooms / 2);
    mark_ways();
    for (const Room& room : rooms_) furnish(room.low, room.high);
    const double half = config_.corridor_width_m / 2.0;
    furnish({low_.x(), -half}, {high_.x(), half});
    return {BoxTree(std::move(boxes_)), std::move(rooms_)};
  }

 private:
  void add_wall(double x0, double y0, double x1, double y1, double from_m = 0.0) {
    boxes_.push_back(
        block({x0, std::min(y0, y1), from_m}, {x1, std::max(y0, y1), config_.height_m}));
  }

  void add_shell() {
    const Vector2d out_low = low_.array() - kWall, out_high = high_.array() + kWall;
    const double height = config_.height_m;
    boxes_.push_back(block({out_low.x(), out_low.y(), -kWall}, {out_high.x(), out_high.y(), 0.0}));
    boxes_.push_back(
        block({out_low.x(), out_low.y(), height}, {out_high.x(), out_high.y(), height + kWall}));
    add_wall(out_low.x(), out_low.y(), low_.x(), out_high.y());
    add_wall(high_.x(), out_low.y(), out_high.x(), out_high.y());
    add_wall(low_.x(), out_low.y(), high_.x(), low_.y());
    add_wall(low_.x(), high_.y(), high_.x(), out_high.y());
  }

  // The rooms of one side of the corridor: +1 left (y > 0), -1 right.
  void add_side(double side, int count) {
    const double corridor = side * config_.corridor_width_m / 2.0;
    if (count == 0) return add_wall(low_.x(), corridor, high_.x(), corridor + side * kWall);
    const double width = config_.length_m / count;
    double from = low_.x();
    for (int i = 0; i < count; ++i) {
      const bool last = i + 1 == count;
      const double to = last ? high_.x() : low_.x() + width * (i + 1 + random_.uniform(-0.1, 0.1));
      add_room(side, from, to);
      if (!last) add_wall(to, corridor, to + kWall, side * high_.y());
      from = last ? to : to + kWall;
    }
  }

  void add_room(double side, double x0, double x1) {
    const double corridor = side * config_.corridor_width_m / 2.0;
    const double inner = corridor + side * kWall, outer = side * high_.y();
    const double door = random_.uniform(x0 + kDoorFromCorner, x1 - kDoorFromCorner);
    const double door0 = door - kDoorWidth / 2.0, door1 = door + kDoorWidth / 2.0;
    add_wall(x0, corridor, door0, inner);
    add_wall(door1, corridor, x1, inner);
    add_wall(door0, corridor, door1, inner, kDoorHeight);
    rooms_.push_back({{x0, std::min(inner, outer)},
                      {x1, std::max(inner, outer)},
                      {door, corridor + side * kWall / 2.0}});
  }

  void mark_ways() {
    mark_way({0.0, 0.0}, {high_.x() - kWayHalfWidth, 0.0});
    for (const Room& room : rooms_) {
      const double in = room.door.y() + std::copysign(kWayHalfWidth, room.door.y());
      mark_way({room.door.x(), 0.0}, {room.door.x(), in});
      mark_way({room.door.x(), in}, room.centre());
    }
  }

  void mark_way(const Vector2d& from, const Vector2d& to) {
    const int steps = 1 + static_cast<int>((to - from).norm() / 0.1);
    for (int i = 0; i <= steps; ++i) ways_.push_back(from + (to - from) * i / steps);
  }

  void furnish(const Vector2d& low, const Vector2d& high) {
    for (int i = 0; i < config_.furniture_per_room; ++i) {
      switch (random_.bits() % 4) {
        case 0:
          add_table(low, high);
          break;
        case 1:
          add_column(low, high);
          break;
        default:
          add_shelf(low, high);
          break;
      }
    }
  }

  void add_table(const Vector2d& low, const Vector2d& high) {
    const Vector2d centre = point_in(low, high, 0.5);
    const double yaw = random_.uniform(0.0, std::numbers::pi);
    const double length = random_.uniform(1.0, 1.6), width = random_.uniform(0.6, 0.8);
    const Box all = standing(centre, {length, width, kTableHeight}, yaw);
    if (!fits(all, low, high)) return;
    Box top = all;
    top.half_m.z() = kTableTop / 2.0;
    top.centre_m.z() = kTableHeight - kTableTop / 2.0;
    boxes_.push_back(top);
    for (const double sx : {-1.0, 1.0})
      for (const double sy : {-1.0, 1.0}) {
        const double x = sx * (length / 2.0 - kTableOverhang);
        const double y = sy * (width / 2.0 - kTableOverhang);
        const Vector2d leg{centre.x() + std::cos(yaw) * x - std::sin(yaw) * y,
                           centre.y() + std::sin(yaw) * x + std::cos(yaw) * y};
        boxes_.push_back(standing(leg, {kTableLeg, kTableLeg, kTableHeight - kTableTop}, yaw));
      }
  }

  void add_column(const Vector2d& low, const Vector2d& high) {
    const Vector2d centre = point_in(low, high, 0.2);
    add_if_it_fits(standing(centre, {0.3, 0.3, config_.height_m}), low, high);
  }

  // Against one of the four walls.
  void add_shelf(const Vector2d& low, const Vector2d& high) {
    const std::uint64_t wall = random_.bits() % 4;
    const double length = random_.uniform(0.6, 1.8), depth = random_.uniform(0.25, 0.45);
    const double height = random_.uniform(0.8, std::min(2.2, config_.height_m));
    const bool along_x = wall < 2;
    const Vector3d size =
        along_x ? Vector3d(length, depth, height) : Vector3d(depth, length, height);
    Vector2d centre = point_in(low, high, length / 2.0);
    const Eigen::Index across = along_x ? 1 : 0;
    centre[across] = wall % 2 == 0 ? low[across] + depth / 2.0 : high[across] - depth / 2.0;
    add_if_it_fits(standing(centre, size), low, high);
  }

  Vector2d point_in(const Vector2d& low, const Vector2d& high, double border) {
    const double x = random_.uniform(low.x() + border, high.x() - border);
    const double y = random_.uniform(low.y() + border, high.y() - border);
    return {x, y};
  }

  void add_if_it_fits(const Box& box, const Vector2d& low, const Vector2d& high) {
    if (fits(box, low, high)) boxes_.push_back(box);
  }

  bool fits(const Box& box, const Vector2d& low, const Vector2d& high) const {
    const double c = std::abs(std::cos(box.yaw_rad)), s = std::abs(std::sin(box.yaw_rad));
    const Vector2d half{c * box.half_m.x() + s * box.half_m.y(),
                        s * box.half_m.x() + c * box.half_m.y()};
    const Vector2d centre = box.centre_m.head<2>();
    constexpr double kSlack = 1e-9;
    return ((centre - half).array() > low.array() - kSlack).all() &&
           ((centre + half).array() < high.array() + kSlack).all() &&
           std::all_of(ways_.begin(), ways_.end(), [&box](const Vector2d& point) {
             return box.distance_m(point) >= kWayHalfWidth;
           });
  }

  const BuildingConfig config_;
  Random random_;
  const Vector2d low_, high_;
  std::vector<Box> boxes_;
  std::vector<Room> rooms_;
  std::vector<Vector2d> ways_;
};

void check(const BuildingConfig& config) {
  const double room_depth = (config.depth_m - config.corridor_width_m) / 2.0 - kWall;
  const double room_width = 0.8 * config.length_m / std::max(1, (config.rooms + 1) / 2) - kWall;
  if (config.rooms < 0 || room_depth < kRoomMin || room_width < kRoomMin ||
      config.corridor_width_m < 2.0 * kWayHalfWidth || config.height_m <= kDoorHeight)
    throw std::invalid_argument("building: too small for its rooms, corridor or doors");
}

}  // namespace

double Building::clearance_m(const Vector2d& point, double low_m, double high_m) const {
  double clearance = std::numeric_limits<double>::infinity();
  for (const Box& box : solid.boxes())
    if (box.top_m() > low_m && box.bottom_m() < high_m)
      clearance = std::min(clearance, box.distance_m(point));
  return clearance;
}

Building make_building(const BuildingConfig& config) {
  check(config);
  return Builder(config).build();
}

}  // namespace voxlist
