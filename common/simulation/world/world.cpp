#include "voxlist/simulation/world/world.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "voxlist/simulation/world/people.h"

namespace voxlist::simulation {

World::World(Building building, std::vector<Trajectory> people)
    : building_(std::move(building)), people_(std::move(people)) {}

std::optional<double> World::range(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                   double t_s) const {
  constexpr double kNothing = std::numeric_limits<double>::infinity();
  double nearest = building_.solid.range(origin, direction).value_or(kNothing);
  for (const Trajectory& person : people_)
    for (const Box& part : person_at(person.at(t_s)))
      nearest = std::min(nearest, part.range_m(origin, direction).value_or(kNothing));
  return nearest < kNothing ? std::optional(nearest) : std::nullopt;
}

}  // namespace voxlist::simulation
