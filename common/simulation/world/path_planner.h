#pragma once

#include <Eigen/Core>
#include <vector>

#include "voxlist/simulation/building/building.h"

namespace voxlist::simulation {

/// What a path has to leave room for.
struct TourConfig {
  double robot_radius_m = 0.25;
  double margin_m = 0.12;       ///< beyond the radius: what the robot may stray from the path
  double robot_height_m = 1.0;  ///< higher boxes do not matter; table tops do
  double cell_m = 0.1;          ///< of the grid that the path is searched on
};

/// Finds ways through a building on a grid: they keep radius and margin from every box and hole,
/// and prefer the middle of free space (A*).
class PathPlanner {
 public:
  PathPlanner(const Building& building, const TourConfig& config);

  /// Grid points, about a cell apart, from the one nearest to `from` to the one nearest to `to`,
  /// both in; empty when there is no way.
  std::vector<Eigen::Vector2d> path(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

 private:
  std::vector<Eigen::Vector2d> trace(const std::vector<int>& parent, int start, int goal) const;
  int neighbour(int at, int dx, int dy) const;
  Eigen::Vector2d point(int i) const;
  int index(const Eigen::Vector2d& point) const;

  const double cell_m_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  int nx_ = 0, ny_ = 0;
  std::vector<double> price_;  // of a metre in each cell; infinite where the robot does not fit
};

}  // namespace voxlist::simulation
