#include "voxlist/mapping/graph/pose_tree.h"

#include <gtest/gtest.h>

#include "tests/mapping/graph/block_drive.h"

namespace voxlist::mapping {
namespace {

TEST(PoseTree, TellsTheWayBetweenAsComposingItsEdgesDoes) {
  const BlockDrive drive(60, 2);
  const PoseTree tree(60, drive.steps);
  UncertainPose composed = drive.steps[10].T_from_to;
  for (std::size_t i = 11; i < 50; ++i) composed = composed * drive.steps[i].T_from_to;
  const UncertainPose told = tree.between(10, 50);
  EXPECT_LT(distance_m(told.pose, composed.pose), 1e-9);
  EXPECT_TRUE(told.covariance.isApprox(composed.covariance, 1e-9));
  EXPECT_NEAR(tree.way_m(10, 50), 40.0, 1.0);
}

TEST(PoseTree, GoesOverBranchesInBothDirections) {
  const PoseEdge stem{0, 1, {{3.0, 0.0, 0.7}, variance(0.1, 0.01)}},
      left{1, 2, {{2.0, 1.0, -0.4}, variance(0.2, 0.02)}},
      right{1, 3, {{1.0, -2.0, 2.0}, variance(0.3, 0.03)}};
  const PoseTree tree(4, std::vector{stem, left, right});
  const UncertainPose told = tree.between(2, 3),
                      composed = reversed(left).T_from_to * right.T_from_to;
  EXPECT_LT(distance_m(told.pose, composed.pose), 1e-9);
  EXPECT_TRUE(told.covariance.isApprox(composed.covariance, 1e-9));
}

TEST(PoseTree, TakesEdgesInAnyOrderAndFromEitherEnd) {
  const BlockDrive drive(60, 3);
  const PoseTree tree(60, drive.steps);
  std::vector<PoseEdge> mixed;
  for (std::size_t i = 0; i < drive.steps.size(); ++i) {
    const PoseEdge& edge = drive.steps[(i * 7) % drive.steps.size()];
    mixed.push_back(i % 2 ? reversed(edge) : edge);
  }
  const PoseTree sorted(60, in_tree_order(mixed));
  for (std::size_t i = 0; i < 60; i += 9) {
    EXPECT_LT(distance_m(sorted.between(i, 59).pose, tree.between(i, 59).pose), 1e-9);
    EXPECT_NEAR(sorted.way_m(i, 59), tree.way_m(i, 59), 1e-9);
  }
}

TEST(PoseEdge, ReversedTwiceIsTheSame) {
  const PoseEdge edge{4, 7, {{2.0, -1.0, 0.4}, variance(0.1, 0.05)}},
      twice = reversed(reversed(edge));
  EXPECT_EQ(twice.from, 4u);
  EXPECT_LT(distance_m(twice.T_from_to.pose, edge.T_from_to.pose), 1e-12);
  EXPECT_TRUE(twice.T_from_to.covariance.isApprox(edge.T_from_to.covariance, 1e-9));
  // Seen from the other end, a turn there moves the first one by the lever.
  EXPECT_NEAR(reversed(edge).T_from_to.covariance.topLeftCorner(2, 2).trace(),
              2 * 0.01 + 0.0025 * 5.0, 1e-9);
}

}  // namespace
}  // namespace voxlist::mapping
