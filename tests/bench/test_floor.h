#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/cloud.h"
#include "geometry/pose.h"
#include "simulation/floor.h"
#include "simulation/ideal_sweep.h"
#include "simulation/random.h"
#include "voxels/occupancy_map.h"

namespace voxlist {

/// A simulated floor with a map made at true poses, for placing queries in.
struct TestFloor {
  std::string name;
  Building building;
  Eigen::Vector2d low, high;  ///< where the robot may be
  OccupancyMap map;
};

struct TestFloorConfig {
  std::string name;
  BuildingConfig wing;
  int wings = 1;
  double map_scan_spacing_m = 1.0;  ///< one map scan for each square of this edge
};

/// 60 x 40 m: three wings of 60 x 13.3 m. Seeds are the building's.
TestFloorConfig floor_60_40(int seed);

/// Builds the floor and its map: a scan in each square, where there is room for the robot.
TestFloor make_test_floor(const TestFloorConfig& config);

/// A pose that leaves the robot room, anywhere on the floor.
Pose2 free_pose(const TestFloor& floor, Random& random);

/// The scan of a robot that stands there, with people round it.
Cloud scan_at(const Building& building, const Pose2& pose, int people, std::uint64_t seed);

}  // namespace voxlist
