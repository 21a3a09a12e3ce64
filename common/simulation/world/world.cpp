#include "voxlist/simulation/world/world.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "voxlist/simulation/world/people.h"

namespace voxlist::simulation {

namespace {

Box placed(Box box, const Pose2& pose) {
  box.centre_m = pose * box.centre_m;
  box.yaw_rad += pose.yaw_rad;
  return box;
}

}  // namespace

World::World(Building building, std::vector<Trajectory> people, std::vector<MovingBody> robots)
    : building_(std::move(building)), people_(std::move(people)), robots_(std::move(robots)) {}

std::optional<double> World::range(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                   double t_s) const {
  constexpr double kNothing = std::numeric_limits<double>::infinity();
  double nearest = building_.solid.range(origin, direction).value_or(kNothing);
  for (const Trajectory& person : people_)
    for (const Box& part : person_at(person.at(t_s)))
      nearest = std::min(nearest, part.range_m(origin, direction).value_or(kNothing));
  for (const MovingBody& robot : robots_)
    for (const Box& box : robot.boxes)
      nearest = std::min(
          nearest, placed(box, robot.way.at(t_s)).range_m(origin, direction).value_or(kNothing));
  return nearest < kNothing ? std::optional(nearest) : std::nullopt;
}

}  // namespace voxlist::simulation
