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

}  // namespace
}  // namespace voxlist::mapping
