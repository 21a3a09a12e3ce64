// A planner as its author would write it: an exported OctoMap (map.bt), OMPL for the way, FCL for
// collisions. FCL takes unknown voxels for free, so these are asked for here: a robot whose body
// reaches into one does not fit.
// Usage: octomap_planner MAP.bt RADIUS_M LOW_M HIGH_M X Y GOAL_X GOAL_Y: the robot is a cylinder
// between two heights above the floor. Writes the way, a point "X Y" a line; exit code 1: none
// found.
#include <fcl/fcl.h>
#include <octomap/OcTree.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>

using Space = ompl::base::RealVectorStateSpace;

constexpr unsigned kMostTries = 100'000;

struct Robot {
  bool fits(double x, double y) const { return !collides(x, y) && is_known_at(x, y); }

  bool collides(double x, double y) const {
    const Eigen::Vector3d middle(x, y, (low_m + high_m) / 2.0);
    const fcl::CollisionObjectd robot(body, Eigen::Matrix3d::Identity(), middle);
    fcl::CollisionResultd result;
    return fcl::collide(&robot, &world, fcl::CollisionRequestd(), result) > 0;
  }

  // Whether all voxels that the body reaches into are free or occupied.
  bool is_known_at(double x, double y) const {
    const auto low = map->coordToKey(x - radius_m, y - radius_m, low_m),
               high = map->coordToKey(x + radius_m, y + radius_m, high_m);
    octomap::OcTreeKey key;
    for (key[0] = low[0]; key[0] <= high[0]; ++key[0])
      for (key[1] = low[1]; key[1] <= high[1]; ++key[1])
        for (key[2] = low[2]; key[2] <= high[2]; ++key[2])
          if (distance_m(key, x, y) < radius_m && !map->search(key)) return false;
    return true;
  }

  // How far the nearest point of a voxel is from the body's axis.
  double distance_m(const octomap::OcTreeKey& key, double x, double y) const {
    const double half_m = map->getResolution() / 2.0;
    return std::hypot(std::max(0.0, std::abs(x - map->keyToCoord(key[0])) - half_m),
                      std::max(0.0, std::abs(y - map->keyToCoord(key[1])) - half_m));
  }

  std::shared_ptr<const octomap::OcTree> map;
  double radius_m, low_m, high_m;
  std::shared_ptr<fcl::Cylinderd> body = std::make_shared<fcl::Cylinderd>(radius_m, high_m - low_m);
  fcl::CollisionObjectd world{std::make_shared<fcl::OcTreed>(map)};
};

ompl::base::RealVectorBounds bounds_of(const octomap::OcTree& map) {
  std::array<double, 3> low{}, high{};
  map.getMetricMin(low[0], low[1], low[2]);
  map.getMetricMax(high[0], high[1], high[2]);
  ompl::base::RealVectorBounds bounds(2);
  for (unsigned axis : {0U, 1U}) bounds.setLow(axis, low[axis]), bounds.setHigh(axis, high[axis]);
  return bounds;
}

int main(int argc, char** argv) {
  if (argc != 9) return 2;
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
  ompl::RNG::setSeed(1);
  const auto number = [&](int i) { return std::atof(argv[i]); };
  const auto map = std::make_shared<octomap::OcTree>(argv[1]);
  const Robot robot{map, number(2), number(3), number(4)};
  if (!robot.fits(number(5), number(6)) || !robot.fits(number(7), number(8))) return 1;
  const auto space = std::make_shared<Space>(2);
  space->setBounds(bounds_of(*map));

  ompl::geometric::SimpleSetup setup(space);
  setup.setStateValidityChecker([&](const ompl::base::State* state) {
    const double* at = state->as<Space::StateType>()->values;
    return robot.fits(at[0], at[1]);
  });
  // States on a way are looked at a quarter of a voxel apart.
  setup.getSpaceInformation()->setStateValidityCheckingResolution(map->getResolution() / 4.0 /
                                                                  space->getMaximumExtent());
  setup.setPlanner(std::make_shared<ompl::geometric::RRTConnect>(setup.getSpaceInformation()));
  ompl::base::ScopedState<Space> start(space), goal(space);
  for (int axis : {0, 1}) start[axis] = number(5 + axis), goal[axis] = number(7 + axis);
  setup.setStartAndGoalStates(start, goal);
  ompl::base::IterationTerminationCondition patience(kMostTries);
  if (setup.solve(patience) != ompl::base::PlannerStatus::EXACT_SOLUTION) return 1;
  for (const ompl::base::State* state : setup.getSolutionPath().getStates()) {
    const double* at = state->as<Space::StateType>()->values;
    std::cout << at[0] << ' ' << at[1] << '\n';
  }
}
