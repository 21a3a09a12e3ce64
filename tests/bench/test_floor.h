#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/simulation/floor.h"
#include "tests/simulation/sphere_scan.h"
#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/simulation/random.h"
#include "voxlist/simulation/scanner/ideal_sweep.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::bench {

/// A simulated floor, and how its map is made.
struct TestFloorConfig {
  std::string name;
  simulation::BuildingConfig wing;
  int wings = 1;
  double map_scan_spacing_m = 1.0;  ///< one map scan for each square of this edge
  bool map_of_spheres = false;      ///< map scans by a laser that sees all round, to 30 m
  /// Standard deviations of the errors of the poses that map scans are added at, each coordinate's:
  /// 0 maps at true poses.
  double misplaced_m = 0.0, misplaced_rad = 0.0;
};

/// 60 x 40 m: three wings of 60 x 13.3 m. Seeds are the building's.
TestFloorConfig floor_60_40(int seed);

/// 16 x 13 m: one wing of four rooms, for a quick run.
TestFloorConfig floor_16_13(int seed);

/// The same with one map scan for each 6 m2.
TestFloorConfig few_scans_floor(int seed);

/// 200 x 150 m: eleven wings of 200 x 13.6 m, 66 rooms each; about 30,000 map scans.
TestFloorConfig floor_200_150(int seed);

/// 40 x 25 m, for dense scans: two wings; a sphere scan every 4 m2 is its map.
TestFloorConfig floor_40_25(int seed);

/// 40 x 26 m: two wings of 16 rooms that are alike but for two small objects in each.
TestFloorConfig hotel_floor(int seed);

/// The same without the objects: nothing tells one room from another.
TestFloorConfig identical_floor(int seed);

/// A simulated floor with its map, for placing queries in.
struct TestFloor {
  std::string name;
  TestFloorConfig config;
  simulation::Building building;
  Eigen::Vector2d low, high;  ///< where the robot may be
  OccupancyMap map;
};

/// The same floor mapped as a robot would: each map scan is misplaced a little, by itself.
TestFloorConfig misplaced(TestFloorConfig config);

/// Builds the floor and its map: a scan in each square, where there is room for the robot. The same
/// bits for any number of threads.
TestFloor make_test_floor(const TestFloorConfig& config);

/// The floor a while later: furniture is moved, gone, new.
simulation::Building later(TestFloorConfig config);

/// A floor of the same kind elsewhere.
TestFloorConfig elsewhere(TestFloorConfig config);

/// A pose that leaves the robot room, anywhere on the floor.
Pose2 free_pose(const TestFloor& floor, simulation::Random& random);

/// The scan of a robot that stands there, with people round it.
Cloud scan_at(const simulation::Building& building, const Pose2& pose, int people,
              std::uint64_t seed);

/// The same by a laser that sees all round, from 1 m above the floor to 30 m away.
Cloud sphere_scan_at(const simulation::Building& building, const Pose2& pose, int points = 64'000,
                     int people = 0, std::uint64_t seed = 1);

}  // namespace voxlist::bench
