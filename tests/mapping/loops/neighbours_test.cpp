// What joins the keyframes of a drive round a block of houses.
#include "voxlist/mapping/loops/neighbours.h"

#include <gtest/gtest.h>

#include "tests/mapping/loops/bent_block.h"
#include "voxlist/mapping/graph/pose_tree.h"

namespace voxlist::mapping {
namespace {

// Round a corner and back over ground that the map has by then, which needs no keyframe until the
// first street is nearly left.
TEST(Neighbours, AWayBackWithoutKeyframesIsJoinedByAMatchRatherThanByVagueOdometry) {
  std::vector<Pose2> poses = way_round(12.0);
  poses.resize(22);
  const std::size_t back = poses.size();
  for (const double along_m : {14.0, 12.0, 10.0}) poses.push_back({along_m, 0.5, M_PI});
  DriveOdometry odometry{Pose2{}};
  for (std::size_t i = 1; i < poses.size(); ++i)
    odometry.push_back(*odometry.back() * poses[i - 1].inverse() * poses[i] *
                       (i == back ? Pose2{-0.3, 1.4, 0.19} : Pose2{}));
  const auto read = [&](std::size_t i) { return scan_block(poses[i], i + 1, 10.0); };
  const PoseTree tree(poses.size(), join_neighbours(poses, odometry, read, {}));
  const std::size_t old = 7;  // on the first street, at 14 m
  const Pose2 T_old_back = tree.between(old, back).pose;
  EXPECT_LT(distance_m(T_old_back, poses[old].inverse() * poses[back]), 0.05);
}

// Two bare walls 2 m apart: nothing tells how far along them a scan was taken.
Cloud scan_corridor(const Pose2& pose, std::uint64_t seed) {
  static const simulation::World world(
      {simulation::BoxTree({simulation::block({-40.0, -3.0, -0.2}, {60.0, 3.0, 0.0}),
                            simulation::block({-40.0, 1.0, 0.0}, {60.0, 1.2, 2.5}),
                            simulation::block({-40.0, -1.2, 0.0}, {60.0, -1.0, 2.5})}),
       {},
       {}});
  return simulation::scan_sphere(
      world, pose,
      {.rays = 32 * 180, .rings = 32, .rings_to_deg = 25.0, .height_m = 1.0, .range_max_m = 8.0},
      seed);
}

// Odometry turns by a degree too much or too little at each step, which walls tell to a twentieth.
TEST(Neighbours, AlongACorridorAMatchTellsYawAndOdometryTheWay) {
  simulation::Random random(5);
  std::vector<Pose2> poses{Pose2{}};
  DriveOdometry odometry{Pose2{}};
  for (int i = 1; i <= 10; ++i) {
    poses.push_back({1.0 * i, 0.0, 0.0});
    odometry.push_back(*odometry.back() * Pose2{1.0, 0.0, 0.02 * random.normal()});
  }
  const auto read = [&](std::size_t i) { return scan_corridor(poses[i], i + 1); };
  const PoseTree tree(poses.size(), join_neighbours(poses, odometry, read, {}));
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Pose2 step = tree.between(i - 1, i).pose;
    EXPECT_NEAR(step.yaw_rad, 0.0, 0.002);
    EXPECT_NEAR(step.x_m, 1.0, 0.02);
  }
}

}  // namespace
}  // namespace voxlist::mapping
