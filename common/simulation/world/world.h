#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/world/trajectory.h"

namespace voxlist::simulation {

/// Something that drives about: boxes in its own frame, and where that is.
struct MovingBody {
  Trajectory way;
  std::vector<Box> boxes;
};

/// A building, which stands, and what moves in it: people, who walk, and other robots.
class World {
 public:
  explicit World(Building building, std::vector<Trajectory> people = {},
                 std::vector<MovingBody> robots = {});

  /// Distance along the unit vector `direction` to the first thing hit at a time; none when the ray
  /// leaves the world.
  std::optional<double> range(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                              double t_s) const;

  const Building& building() const { return building_; }
  const std::vector<Trajectory>& people() const { return people_; }

 private:
  const Building building_;
  const std::vector<Trajectory> people_;
  const std::vector<MovingBody> robots_;
};

}  // namespace voxlist::simulation
