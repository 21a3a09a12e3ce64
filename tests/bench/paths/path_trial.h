#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tests/bench/paths/free_cells.h"
#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/random.h"

namespace voxlist::bench {

/// A robot as the planners are told of it: a cylinder between two heights.
struct Body {
  double radius_m, low_m, high_m;
  /// What planners keep away from all they know, beyond the radius (m): the map's errors.
  double margin_m = 0.04;
};

inline constexpr Body kLowRobot{0.25, 0.06, 0.4}, kTallRobot{0.3, 0.06, 1.2};

/// A scan from every so often along a tour of the building, at its true pose, by a laser that sees
/// all round.
struct PosedScan {
  Pose2 pose;
  Cloud cloud;
};
std::vector<PosedScan> scans_along_tour(const simulation::Building& building, double spacing_m,
                                        std::uint64_t seed);

/// The scans of a robot with the mirror scanner that drives that tour, one a second.
std::vector<PosedScan> mirror_scans_along_tour(const simulation::Building& building,
                                               std::uint64_t seed);

/// Corners of what a robot may drive in.
struct Area {
  Eigen::Vector2d low, high;
};
Area area_of(const simulation::Building& building);

/// Where a robot is, and where it shall go: both leave it room, in the building and in what is
/// known of it.
struct Errand {
  Eigen::Vector2d start, goal;
};
Errand random_errand(const simulation::Building& building, const FreeCells& known, const Body& body,
                     simulation::Random& random);

/// The points that a planner writes, a line "X Y" each; empty where it finds no way.
std::vector<Eigen::Vector2d> points_of(const std::string& command);

/// What planners did with their errands.
struct PathTally {
  int errands = 0;
  int ways = 0;      ///< errands to whose goal a search of all cells finds a way
  int missed = 0;    ///< no path, though there is a way
  int found = 0;     ///< paths
  int collided = 0;  ///< paths that touch the true building
  int through_unknown = 0;

  void add(const Errand& errand, const std::vector<Eigen::Vector2d>& path,
           const simulation::Building& building, const FreeCells& known, const Body& body);
};

}  // namespace voxlist::bench
