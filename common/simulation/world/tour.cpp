#include "voxlist/simulation/world/tour.h"

#include <algorithm>
#include <stdexcept>

namespace voxlist::simulation {
namespace {

using Eigen::Vector2d;
using Path = std::vector<Vector2d>;

// Rooms in the order of a tour: down one side of the corridor and back on the other.
std::vector<Room> rooms_in_order(std::vector<Room> rooms) {
  const auto left = std::stable_partition(rooms.begin(), rooms.end(),
                                          [](const Room& room) { return room.door.y() > 0.0; });
  std::reverse(left, rooms.end());
  return rooms;
}

// From the origin through all rooms and back; or from the corridor before the first room of a
// share.
Path stops(const Building& building, const TourShare& share) {
  const auto robots = static_cast<std::size_t>(share.robots);
  const auto robot = static_cast<std::size_t>(share.robot);
  if (share.robots < 1 || share.robot < 0 || robot >= robots)
    throw std::invalid_argument("tour: there is no such robot");
  if (robots > 1 && building.rooms.size() < robots)
    throw std::invalid_argument("tour: there are fewer rooms than robots");
  std::vector<Room> rooms = rooms_in_order(building.rooms);
  const std::size_t before = robot * rooms.size() / robots;
  std::ranges::rotate(rooms, rooms.begin() + static_cast<std::ptrdiff_t>(before));
  const Vector2d start = robots == 1 ? Vector2d::Zero() : Vector2d(rooms.front().door.x(), 0.0);
  Path stops{start};
  for (const Room& room : rooms) stops.push_back(room.centre());
  stops.push_back(start);
  return stops;
}

}  // namespace

Path plan_tour(const Building& building, const TourConfig& config, const TourShare& share) {
  const PathPlanner planner(building, config);
  const Path stops = simulation::stops(building, share);
  Path tour{stops.front()};
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const Path leg = planner.path(stops[i - 1], stops[i]);
    if (leg.empty()) throw std::runtime_error("tour: a room cannot be reached");
    tour.insert(tour.end(), leg.begin() + 1, leg.end());
  }
  return tour;
}

}  // namespace voxlist::simulation
