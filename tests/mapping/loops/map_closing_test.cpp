// A drive round a block of houses, whose map is bent.
#include "voxlist/mapping/loops/map_closing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/mapping/graph/block_drive.h"
#include "tests/mapping/loops/bent_block.h"

namespace voxlist::mapping {
namespace {

class MapClosingTest : public testing::Test {
 protected:
  Cloud scan(const Pose2& pose, std::size_t i) const {
    if (blind_.contains(i)) return {};
    return scan_block(pose, i + 1, range_m_);
  }

  MapClosing close(const std::vector<Pose2>& poses, const DriveOdometry& odometry = {},
                   LookMemory* memory = nullptr, const DriveHeights& heights_m = {}) {
    return close_map(
        poses, odometry,
        [&](std::size_t i) {
          ++reads_;
          return scan(truth_[i], i);
        },
        {}, {}, memory, heights_m);
  }

  std::vector<Pose2> truth_ = way_round(12.0);
  std::set<std::size_t> blind_;
  double range_m_ = 25.0;
  int reads_ = 0;
};

TEST_F(MapClosingTest, ADriveRoundABlockCloses) {
  const std::vector<Pose2> before = bent(truth_);
  ASSERT_GT(rmse_m(before, truth_), 0.5);
  const MapClosing closing = close(before);
  EXPECT_TRUE(closing.moves);
  EXPECT_GE(closing.loops, 4u);
  ASSERT_EQ(closing.poses.size(), truth_.size());
  EXPECT_LT(rmse_m(closing.poses, truth_), 0.03);
  EXPECT_EQ(closing.refused, 0u);
  EXPECT_EQ(closing.poses, close(before).poses);
}

TEST_F(MapClosingTest, WhatWasLookedAtIsNotLookedAtAgainUntilItMoves) {
  const std::vector<Pose2> before = bent(truth_);
  const MapClosing without = close(before);
  LookMemory memory;
  EXPECT_EQ(close(before, {}, &memory).poses, without.poses);
  reads_ = 0;
  EXPECT_EQ(close(before, {}, &memory).poses, without.poses);
  EXPECT_EQ(reads_, 0);
  std::vector<Pose2> moved = before;
  moved.back() = moved.back() * Pose2{0.01, 0.0, 0.0};
  const MapClosing then = close(moved, {}, &memory);
  EXPECT_GT(reads_, 0);
  EXPECT_EQ(then.poses, close(moved).poses);
}

TEST_F(MapClosingTest, AMapThatIsClosedStaysAsItIs) {
  const MapClosing closing = close(truth_);
  EXPECT_GT(reads_, 0);
  EXPECT_FALSE(closing.moves);
  EXPECT_EQ(closing.poses, truth_);
}

// On the second side of the block nothing is seen, and the tracker went 1 m astray there.
TEST_F(MapClosingTest, WhereNoMatchTellsAStepOdometryDoes) {
  std::vector<Pose2> before = bent(truth_);
  for (std::size_t i = 18; i < 23; ++i) blind_.insert(i);
  for (std::size_t i = 20; i < before.size(); ++i) before[i] = Pose2{1.0, 0.0, 0.0} * before[i];
  simulation::Random random(3);
  DriveOdometry odometry{Pose2{7.0, -3.0, 1.0}};
  for (std::size_t i = 1; i < truth_.size(); ++i)
    odometry.push_back(*odometry.back() * truth_[i - 1].inverse() * truth_[i] *
                       noise(random, 0.01, 0.01));
  const MapClosing without = close(before), with = close(before, odometry);
  EXPECT_TRUE(with.moves);
  EXPECT_LT(rmse_m(with.poses, truth_), 0.04);
  EXPECT_GT(rmse_m(without.poses, truth_), 2.0 * rmse_m(with.poses, truth_));
}

// Along a street and on after a long step, by which a tracker was wrong.
TEST_F(MapClosingTest, AStepThatNoMatchTellsIsToldByLooksAcrossIt) {
  range_m_ = 40.0;
  truth_.clear();
  for (const double along_m : {-4.0, -2.0, 0.0, 2.0, 4.0, 20.0, 22.0, 24.0, 26.0, 28.0})
    truth_.push_back({along_m, 0.0, 0.0});
  std::vector<Pose2> before = truth_;
  for (std::size_t i = 5; i < before.size(); ++i) before[i] = Pose2{-1.5, 2.4, 0.0} * before[i];
  const MapClosing closing = close(before);
  EXPECT_TRUE(closing.moves);
  EXPECT_LT(rmse_m(closing.poses, truth_), 0.05);
}

// It comes back on the next floor, which looks the same.
TEST_F(MapClosingTest, NoLoopJoinsTwoStoreys) {
  DriveHeights heights_m(truth_.size(), 0.0);
  std::fill(heights_m.begin() + 25, heights_m.end(), 3.0);
  const MapClosing closing = close(bent(truth_), {}, nullptr, heights_m);
  EXPECT_FALSE(closing.moves);
  EXPECT_EQ(closing.loops, 0u);
  for (const PoseEdge& edge : closing.edges) EXPECT_EQ(edge.to, edge.from + 1);
}

TEST_F(MapClosingTest, WhereADriveDoesNotComeBackNothingIsLookedAt) {
  const std::vector<Pose2> street(truth_.begin(), truth_.begin() + 14);
  EXPECT_FALSE(close(street).moves);
  EXPECT_EQ(reads_, 0);
}

}  // namespace
}  // namespace voxlist::mapping
