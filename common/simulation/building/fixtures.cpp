#include "voxlist/simulation/building/fixtures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>

#include "voxlist/simulation/random.h"

namespace voxlist::simulation {
namespace {

using Eigen::Vector2d;

// A flight of stairs (metres), down to below the last step.
constexpr int kSteps = 8;
constexpr double kRise = 0.18;
constexpr double kTread = 0.25;
constexpr double kStairsWidth = 1.0;
constexpr double kBottom = -(kSteps + 1) * kRise;

// A pipe's thickness, and where its middle is: this far from the corner along each wall, or under
// the ceiling and beside the middle of the corridor. Metres.
constexpr double kPipe = 0.06;
constexpr double kFromCorner = 0.7;
constexpr double kUnderCeiling = 0.25;
constexpr double kBesideMiddle = 0.5;

// A flight of stairs: its hole, and whether it goes down towards greater x.
struct Flight {
  Rectangle hole;
  int down;  // +1 or -1
};

// Stairs along a room's outer wall, from the side of the room's middle down into a corner.
Flight flight_in(const Room& room, int down) {
  const bool left = room.door.y() > 0.0;
  const double length = kSteps * kTread;
  const double x0 = down > 0 ? room.high.x() - length : room.low.x();
  const double y0 = left ? room.high.y() - kStairsWidth : room.low.y();
  return {{{x0, y0}, {x0 + length, y0 + kStairsWidth}}, down};
}

std::optional<Flight> find_place(const FloorPlan& plan, Random& random) {
  const std::size_t rooms = plan.rooms.size();
  const std::uint64_t first = random.bits();
  for (std::size_t i = 0; i < 2 * rooms; ++i) {
    const Room& room = plan.rooms[(first + i / 2) % rooms];
    const Flight flight = flight_in(room, i % 2 == 0 ? 1 : -1);
    const Box footprint = block({flight.hole.low.x(), flight.hole.low.y(), 0.0},
                                {flight.hole.high.x(), flight.hole.high.y(), 1.0});
    if (plan.leaves_room_for(footprint, {room.low, room.high})) return flight;
  }
  return std::nullopt;
}

// What is left of the floor's boxes around the hole: up to four in the place of each.
std::vector<Box> cut(const std::vector<Box>& boxes, const Rectangle& hole) {
  std::vector<Box> rest;
  for (const Box& box : boxes) {
    const Vector2d low = (box.centre_m - box.half_m).head<2>();
    const Vector2d high = (box.centre_m + box.half_m).head<2>();
    const auto keep = [&](double x0, double y0, double x1, double y1) {
      if (x0 < x1 && y0 < y1)
        rest.push_back(block({x0, y0, box.bottom_m()}, {x1, y1, box.top_m()}));
    };
    if (!hole.overlaps({low, high})) {
      rest.push_back(box);
      continue;
    }
    const double x0 = std::max(low.x(), hole.low.x()), x1 = std::min(high.x(), hole.high.x());
    keep(low.x(), low.y(), x0, high.y());
    keep(x1, low.y(), high.x(), high.y());
    keep(x0, low.y(), x1, hole.low.y());
    keep(x0, hole.high.y(), x1, high.y());
  }
  return rest;
}

void add_steps(const Flight& flight, std::vector<Box>& boxes) {
  const auto& [low, high] = flight.hole;
  for (int i = 0; i < kSteps; ++i) {
    const double from = flight.down > 0 ? low.x() + i * kTread : high.x() - (i + 1) * kTread;
    boxes.push_back(block({from, low.y(), kBottom}, {from + kTread, high.y(), -(i + 1) * kRise}));
  }
}

void add_walls_below(const Rectangle& hole, std::vector<Box>& boxes) {
  const auto wall = [&boxes](double x0, double y0, double x1, double y1) {
    boxes.push_back(block({x0, y0, kBottom}, {x1, y1, -kWall_m}));
  };
  const Vector2d low = hole.low.array() - kWall_m, high = hole.high.array() + kWall_m;
  wall(low.x(), low.y(), hole.low.x(), high.y());
  wall(hole.high.x(), low.y(), high.x(), high.y());
  wall(low.x(), low.y(), high.x(), hole.low.y());
  wall(low.x(), hole.high.y(), high.x(), high.y());
}

}  // namespace

void add_stairs(FloorPlan& plan, int count, Random& random) {
  std::vector<Box> floor{plan.boxes.front()}, below;
  for (int i = 0; i < count; ++i) {
    const auto flight = find_place(plan, random);
    if (!flight) throw std::invalid_argument("building: too small for its stairs");
    plan.holes.push_back(flight->hole);
    floor = cut(floor, flight->hole);
    add_steps(*flight, below);
    add_walls_below(flight->hole, below);
  }
  plan.boxes.front() = floor.front();
  plan.boxes.insert(plan.boxes.end(), floor.begin() + 1, floor.end());
  plan.boxes.insert(plan.boxes.end(), below.begin(), below.end());
}

void add_pipes(FloorPlan& plan, const BuildingConfig& config, Random& random) {
  if (config.pipes == 0) return;
  const double length = plan.inside.high.x() - plan.inside.low.x();
  const Vector2d middle = (plan.inside.low + plan.inside.high) / 2.0;
  plan.boxes.push_back({{middle.x(), kBesideMiddle, config.height_m - kUnderCeiling},
                        {length / 2.0, kPipe / 2.0, kPipe / 2.0},
                        0.0});
  const std::size_t rooms = plan.rooms.size();
  const std::uint64_t first = random.bits();
  for (std::size_t i = 0; i < std::min(rooms, static_cast<std::size_t>(config.pipes)); ++i) {
    const Room& room = plan.rooms[(first + i) % rooms];
    const bool at_high_x = random.bits() % 2 == 0;
    const bool left = room.door.y() > 0.0;
    const Vector2d at{at_high_x ? room.high.x() - kFromCorner : room.low.x() + kFromCorner,
                      left ? room.high.y() - kFromCorner : room.low.y() + kFromCorner};
    const double yaw = (at_high_x == left ? -1.0 : 1.0) * std::numbers::pi / 4.0;
    plan.boxes.push_back({{at.x(), at.y(), random.uniform(1.2, 1.6)},
                          {std::numbers::sqrt2 * kFromCorner, kPipe / 2.0, kPipe / 2.0},
                          yaw});
  }
}

}  // namespace voxlist::simulation
