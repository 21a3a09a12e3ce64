#include "voxlist/simulation/world/tour.h"

#include <algorithm>
#include <stdexcept>

namespace voxlist::simulation {
namespace {

using Eigen::Vector2d;
using Path = std::vector<Vector2d>;

// Rooms in the order of a tour: down one side of the corridor and back on the other.
Path stops(const Building& building) {
  std::vector<Room> rooms = building.rooms;
  const auto left = std::stable_partition(rooms.begin(), rooms.end(),
                                          [](const Room& room) { return room.door.y() > 0.0; });
  std::reverse(left, rooms.end());
  Path stops{Vector2d::Zero()};
  for (const Room& room : rooms) stops.push_back(room.centre());
  stops.push_back(Vector2d::Zero());
  return stops;
}

}  // namespace

Path plan_tour(const Building& building, const TourConfig& config) {
  const PathPlanner planner(building, config);
  const Path stops = simulation::stops(building);
  Path tour{stops.front()};
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const Path leg = planner.path(stops[i - 1], stops[i]);
    if (leg.empty()) throw std::runtime_error("tour: a room cannot be reached");
    tour.insert(tour.end(), leg.begin() + 1, leg.end());
  }
  return tour;
}

}  // namespace voxlist::simulation
