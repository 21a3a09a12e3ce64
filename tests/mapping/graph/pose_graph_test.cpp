#include "voxlist/mapping/graph/pose_graph.h"

#include <gtest/gtest.h>

#include "tests/mapping/graph/block_drive.h"

namespace voxlist::mapping {
namespace {

TEST(PoseGraph, PosesThatAgreeWithAllEdgesStayWhereTheyAre) {
  const std::vector<Pose2> poses{{1.0, 2.0, 0.5}, {3.0, 1.0, -2.0}, {0.0, 4.0, 3.0}};
  std::vector<PoseEdge> edges;
  for (const auto& [from, to] : {std::pair{0, 1}, {1, 2}, {2, 0}}) {
    const auto a = static_cast<std::size_t>(from), b = static_cast<std::size_t>(to);
    edges.push_back({a, b, {poses[a].inverse() * poses[b], variance(0.1, 0.1)}});
  }
  const std::vector<Pose2> solved = solve(poses, edges);
  ASSERT_EQ(solved.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(distance_m(solved[i], poses[i]), 1e-9);
    EXPECT_LT(turn_rad(solved[i], poses[i]), 1e-9);
  }
}

TEST(PoseGraph, WhatIsMissingToARingIsSharedByItsEdges) {
  // Four sides with quarter turns; the ring misses 0.2 m in y, a quarter of it for each side.
  std::vector<PoseEdge> edges;
  for (std::size_t i = 0; i < 3; ++i)
    edges.push_back({i, i + 1, {{1.1, 0.0, M_PI / 2}, variance(0.1, 1e-4)}});
  edges.push_back({3, 0, {{0.9, 0.0, M_PI / 2}, variance(0.1, 1e-4)}});
  const std::vector<Pose2> solved = solve({{}, {1, 0, 1.5}, {1, 1, 3}, {0, 1, -1.5}}, edges);
  EXPECT_NEAR(solved[1].x_m, 1.1, 0.001);
  EXPECT_NEAR(solved[1].y_m, -0.05, 0.001);
  EXPECT_NEAR(solved[2].y_m, 1.0, 0.001);
  EXPECT_NEAR(solved[3].x_m, 0.0, 0.001);
  EXPECT_NEAR(solved[3].y_m, 0.95, 0.001);
}

TEST(PoseGraph, AnEdgePullsAsItIsSure) {
  const std::vector<PoseEdge> edges{{0, 1, {{1.0, 0.0, 0.0}, variance(0.1, 0.1)}},
                                    {0, 1, {{2.0, 0.0, 0.0}, variance(0.2, 0.1)}}};
  EXPECT_NEAR(solve({{}, {5.0, 1.0, 0.2}}, edges)[1].x_m, 1.2, 1e-4);
}

TEST(PoseGraph, AKernelLetsGoOfAnEdgeThatIsFarOff) {
  const std::vector<PoseEdge> right{{0, 1, {{1.0, 0.0, 0.0}, variance(0.1, 0.1)}}},
      wrong{{0, 1, {{9.0, 0.0, 0.0}, variance(0.1, 0.1)}}};
  const std::vector<Pose2> start{{}, {1.0, 0.0, 0.0}};
  EXPECT_NEAR(solve(start, right, wrong)[1].x_m, 5.0, 1e-3);
  EXPECT_LT(solve(start, right, wrong, Kernel::kCauchy)[1].x_m, 1.1);
  EXPECT_LT(solve(start, right, wrong, Kernel::kGemanMcClure)[1].x_m, 1.001);
}

TEST(PoseGraph, GivesTheSameBitsTwice) {
  const BlockDrive drive(300, 1);
  std::vector<Pose2> start(drive.truth);
  std::vector<PoseEdge> loops;
  for (const Loop& loop : drive.loops) loops.push_back(loop.edge);
  ASSERT_GT(loops.size(), 20u);
  const std::vector<Pose2> solved = solve(start, drive.steps, loops, Kernel::kCauchy);
  EXPECT_EQ(solved, solve(start, drive.steps, loops, Kernel::kCauchy));
  EXPECT_GT(distance_m(solved.back(), start.back()), 0.001);
}

TEST(PoseGraph, RoundsPosesToWhatMovesNoVoxel) {
  const Pose2 pose = rounded({1.23456, -0.00004, 0.0100001});
  EXPECT_DOUBLE_EQ(pose.x_m, 1.2346);
  EXPECT_DOUBLE_EQ(pose.y_m, 0.0);
  EXPECT_NEAR(pose.yaw_rad, 573e-3 * M_PI / 180.0, 1e-12);
}

}  // namespace
}  // namespace voxlist::mapping
