#include "voxlist/simulation/world/tour.h"

#include <algorithm>
#include <stdexcept>

namespace voxlist::simulation {
namespace {

using Eigen::Vector2d;
using Path = std::vector<Vector2d>;

// Rooms in the order of a tour: down one side of the corridor and back on the other.
Path stops(std::vector<Room> rooms, const Vector2d& start) {
  const auto left = std::stable_partition(rooms.begin(), rooms.end(),
                                          [](const Room& room) { return room.door.y() > 0.0; });
  std::reverse(left, rooms.end());
  Path stops{start};
  for (const Room& room : rooms) stops.push_back(room.centre());
  stops.push_back(start);
  return stops;
}

// The rooms of one share, and a place in the middle of the corridor before the first of them.
Path stops(const Building& building, const TourShare& share) {
  const auto robots = static_cast<std::size_t>(share.robots);
  const auto robot = static_cast<std::size_t>(share.robot);
  if (share.robots < 1 || share.robot < 0 || robot >= robots)
    throw std::invalid_argument("tour: there is no such robot");
  if (robots == 1) return stops(building.rooms, Vector2d::Zero());
  if (building.rooms.size() < robots)
    throw std::invalid_argument("tour: there are fewer rooms than robots");
  std::vector<Room> rooms = building.rooms;
  std::ranges::stable_sort(rooms, {}, [](const Room& room) { return room.door.x(); });
  const auto at = [&](std::size_t i) {
    return rooms.begin() + static_cast<std::ptrdiff_t>(i * rooms.size() / robots);
  };
  const std::vector<Room> own(at(robot), at(robot + 1));
  return stops(own, {own.front().door.x(), 0.0});
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
