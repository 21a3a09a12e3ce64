#include "voxlist/simulation/building/furniture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "voxlist/geometry/elementary.h"
#include "voxlist/simulation/random.h"

namespace voxlist::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A table as offices have it, metres.
constexpr double kTableHeight = 0.74;
constexpr double kTableTop = 0.04;
constexpr double kTableOverhang = 0.15;
constexpr double kTableLeg = 0.05;

// When things have changed: shares of the furniture that is gone and that was moved, and the
// probability that a region has one piece more.
constexpr double kGone = 0.15;
constexpr double kMoved = 0.25;
constexpr double kNew = 0.5;

class Furnisher {
 public:
  Furnisher(const FloorPlan& plan, const BuildingConfig& config, Random& random)
      : plan_(plan), config_(config), random_(random) {}

  // One piece; without boxes when it would stand in the way.
  Furniture piece(const Rectangle& region) {
    switch (random_.bits() % 4) {
      case 0:
        return {region, table(region)};
      case 1:
        return {region, column(region)};
      default:
        return {region, shelf(region)};
    }
  }

  std::vector<Rectangle> regions() const {
    std::vector<Rectangle> regions;
    for (const Room& room : plan_.rooms) regions.push_back({room.low, room.high});
    const double half = config_.corridor_width_m / 2.0;
    regions.push_back({{plan_.inside.low.x(), -half}, {plan_.inside.high.x(), half}});
    return regions;
  }

 private:
  std::vector<Box> table(const Rectangle& region) {
    const Vector2d centre = point_in(region, 0.5);
    const double yaw = random_.uniform(0.0, std::numbers::pi);
    const double length = random_.uniform(1.0, 1.6), width = random_.uniform(0.6, 0.8);
    const Box all = standing(centre, {length, width, kTableHeight}, yaw);
    if (!plan_.leaves_room_for(all, region)) return {};
    Box top = all;
    top.half_m.z() = kTableTop / 2.0;
    top.centre_m.z() = kTableHeight - kTableTop / 2.0;
    std::vector<Box> boxes{top};
    const auto [s, c] = elementary::sine_cosine(yaw);
    for (const double sx : {-1.0, 1.0})
      for (const double sy : {-1.0, 1.0}) {
        const double x = sx * (length / 2.0 - kTableOverhang);
        const double y = sy * (width / 2.0 - kTableOverhang);
        const Vector2d leg{centre.x() + c * x - s * y, centre.y() + s * x + c * y};
        boxes.push_back(standing(leg, {kTableLeg, kTableLeg, kTableHeight - kTableTop}, yaw));
      }
    return boxes;
  }

  std::vector<Box> column(const Rectangle& region) {
    return if_it_fits(standing(point_in(region, 0.2), {0.3, 0.3, config_.height_m}), region);
  }

  // A piece that stands against one of the four walls.
  std::vector<Box> shelf(const Rectangle& region) {
    const std::uint64_t wall = random_.bits() % 4;
    const double length = random_.uniform(0.6, 1.8), depth = random_.uniform(0.25, 0.45);
    const double height = random_.uniform(0.8, std::min(2.2, config_.height_m));
    const bool along_x = wall < 2;
    const Vector3d size =
        along_x ? Vector3d(length, depth, height) : Vector3d(depth, length, height);
    Vector2d centre = point_in(region, length / 2.0);
    const Eigen::Index across = along_x ? 1 : 0;
    centre[across] =
        wall % 2 == 0 ? region.low[across] + depth / 2.0 : region.high[across] - depth / 2.0;
    return if_it_fits(standing(centre, size), region);
  }

  Vector2d point_in(const Rectangle& region, double border) {
    const double x = random_.uniform(region.low.x() + border, region.high.x() - border);
    const double y = random_.uniform(region.low.y() + border, region.high.y() - border);
    return {x, y};
  }

  std::vector<Box> if_it_fits(const Box& box, const Rectangle& region) const {
    return plan_.leaves_room_for(box, region) ? std::vector<Box>{box} : std::vector<Box>{};
  }

  const FloorPlan& plan_;
  const BuildingConfig& config_;
  Random& random_;
};

// A piece of one room in another that is like it; across the corridor rooms are turned round.
Furniture copied(const Furniture& piece, const Room& from, const Room& to) {
  Furniture copy{{to.low, to.high}, piece.boxes};
  const bool same_side = (from.door.y() > 0.0) == (to.door.y() > 0.0);
  for (Box& box : copy.boxes) {
    const Vector2d at = box.centre_m.head<2>() - from.low;
    box.centre_m.head<2>() = same_side ? Vector2d(to.low + at) : Vector2d(to.high - at);
  }
  return copy;
}

bool missing(const Furniture& piece) { return piece.boxes.empty(); }

}  // namespace

std::vector<Furniture> furnish(const FloorPlan& plan, const BuildingConfig& config,
                               Random& random) {
  Furnisher furnisher(plan, config, random);
  std::vector<Furniture> furniture;
  for (const Rectangle& region : furnisher.regions()) {
    for (int i = 0; i < config.furniture_per_room; ++i)
      furniture.push_back(furnisher.piece(region));
    if (config.alike != 0) break;
  }
  std::erase_if(furniture, missing);
  if (config.alike == 0 || plan.rooms.empty()) return furniture;
  std::vector<Furniture> copies;
  for (const Room& room : plan.rooms)
    for (const Furniture& piece : furniture)
      copies.push_back(copied(piece, plan.rooms.front(), room));
  return copies;
}

std::vector<Furniture> rearranged(std::vector<Furniture> furniture, const FloorPlan& plan,
                                  const BuildingConfig& config, Random& random) {
  Furnisher furnisher(plan, config, random);
  for (Furniture& piece : furniture) {
    const double fate = random.uniform(0.0, 1.0);
    if (fate < kGone) piece.boxes.clear();
    if (fate >= kGone && fate < kGone + kMoved) piece = furnisher.piece(piece.region);
  }
  for (const Rectangle& region : furnisher.regions())
    if (random.uniform(0.0, 1.0) < kNew) furniture.push_back(furnisher.piece(region));
  std::erase_if(furniture, missing);
  return furniture;
}

}  // namespace voxlist::simulation
