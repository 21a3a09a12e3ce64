#include "voxlist/simulation/building/building.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "voxlist/simulation/building/fixtures.h"
#include "voxlist/simulation/building/floor_plan.h"
#include "voxlist/simulation/building/furniture.h"
#include "voxlist/simulation/building/objects.h"
#include "voxlist/simulation/random.h"

namespace voxlist::simulation {
namespace {

// Least edge of a room, and least height: that of the doors. Metres.
constexpr double kRoomMin = 2.4;
constexpr double kHeightMin = 2.1;

// Streams of random numbers beside the seed's own, so that one thing more moves nothing else.
enum Stream : std::uint64_t { kStairs = 101, kPipes = 102, kChanges = 103, kObjects = 104 };

void check(const BuildingConfig& config) {
  const double room_depth = (config.depth_m - config.corridor_width_m) / 2.0 - kWall_m;
  const double room_width = 0.8 * config.length_m / std::max(1, (config.rooms + 1) / 2) - kWall_m;
  if (config.rooms < 0 || room_depth < kRoomMin || room_width < kRoomMin ||
      config.corridor_width_m < 2.0 * kWayHalfWidth_m || config.height_m <= kHeightMin)
    throw std::invalid_argument("building: too small for its rooms, corridor or doors");
  if (config.alike != 0 && (config.rooms % 2 != 0 || config.stairs != 0))
    throw std::invalid_argument("building: rooms that are alike come in pairs, without stairs");
}

// A lower bound of the distance that is quick to find.
double least_distance_m(const Box& box, const Eigen::Vector2d& point) {
  return (box.centre_m.head<2>() - point).norm() - box.half_m.head<2>().norm();
}

}  // namespace

double Rectangle::distance_m(const Eigen::Vector2d& point) const {
  return (low - point).cwiseMax(point - high).cwiseMax(0.0).norm();
}

bool Rectangle::overlaps(const Rectangle& other) const {
  return (low.array() < other.high.array()).all() && (other.low.array() < high.array()).all();
}

double Building::clearance_m(const Eigen::Vector2d& point, double low_m, double high_m) const {
  double clearance = std::numeric_limits<double>::infinity();
  for (const Rectangle& hole : holes) clearance = std::min(clearance, hole.distance_m(point));
  for (const Box& box : solid.boxes())
    if (box.top_m() > low_m && box.bottom_m() < high_m && least_distance_m(box, point) < clearance)
      clearance = std::min(clearance, box.distance_m(point));
  return clearance;
}

Building make_building(const BuildingConfig& config) {
  check(config);
  const auto seed = static_cast<std::uint64_t>(config.seed);
  Random random(config.alike != 0 ? static_cast<std::uint64_t>(config.alike) : seed);
  Random stairs(seed, kStairs), pipes(seed, kPipes), small(seed, kObjects);
  FloorPlan plan = make_floor_plan(config, random);
  add_stairs(plan, config.stairs, stairs);
  std::vector<Furniture> furniture = furnish(plan, config, random);
  const std::vector<Box> objects = place_objects(plan, furniture, config.objects, small);
  if (config.changed != 0) {
    Random changes(static_cast<std::uint64_t>(config.changed), kChanges + seed);
    furniture = rearranged(std::move(furniture), plan, config, changes);
  }
  add_pipes(plan, config, pipes);
  for (const Furniture& piece : furniture)
    plan.boxes.insert(plan.boxes.end(), piece.boxes.begin(), piece.boxes.end());
  plan.boxes.insert(plan.boxes.end(), objects.begin(), objects.end());
  return {BoxTree(std::move(plan.boxes)), std::move(plan.rooms), std::move(plan.holes)};
}

}  // namespace voxlist::simulation
