#include "voxlist/mapping/graph/loop_closing.h"

#include <gtest/gtest.h>

#include "tests/mapping/graph/block_drive.h"

namespace voxlist::mapping {
namespace {

constexpr std::size_t kKeyframes = 800;

ClosedDrive closed(const BlockDrive& drive) {
  return close_loops(PoseTree(kKeyframes, drive.steps), drive.steps, drive.loops);
}

std::vector<Pose2> open(const BlockDrive& drive) {
  return close_loops(PoseTree(kKeyframes, drive.steps), drive.steps, {}).poses;
}

TEST(LoopClosing, ADriveRoundBlocksComesTogether) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const BlockDrive drive(kKeyframes, seed);
    ASSERT_GE(drive.loops.size(), 100u);
    const ClosedDrive result = closed(drive);
    EXPECT_GT(result.loops.size(), 4 * drive.loops.size() / 5) << seed;
    EXPECT_LT(rmse_m(result.poses, drive.truth), 0.6 * rmse_m(open(drive), drive.truth)) << seed;
  }
}

TEST(LoopClosing, NoWrongLoopAmongRightOnesIsBelieved) {
  for (std::uint64_t seed = 11; seed <= 14; ++seed) {
    BlockDrive drive(kKeyframes, seed);
    const ClosedDrive right = closed(drive);
    const std::size_t looks = drive.loops.size();
    simulation::Random random(seed, 1);
    for (int group = 0; group < 10; ++group) {
      const auto from = static_cast<std::size_t>(random.uniform(0, kKeyframes / 2 - 10));
      const auto to = static_cast<std::size_t>(random.uniform(kKeyframes / 2, kKeyframes - 10));
      // Half of them where the drive may well have been.
      const double far_m = group % 2 ? 20.0 : 1.0;
      drive.forge(from, to, {random.uniform(0.5, far_m), random.uniform(0.5, far_m), 0.0});
    }
    const ClosedDrive all = closed(drive);
    for (const Loop& loop : all.loops) EXPECT_LT(loop.look, looks) << seed;
    EXPECT_GT(all.loops.size(), looks / 2);
    EXPECT_LE(rmse_m(all.poses, drive.truth), 1.1 * rmse_m(right.poses, drive.truth)) << seed;
  }
}

TEST(LoopClosing, ThreeLooksAloneAreNotBelieved) {
  BlockDrive drive(kKeyframes, 3);
  drive.loops.clear();
  drive.forge(10, 500, {});
  const ClosedDrive result = closed(drive);
  EXPECT_TRUE(result.loops.empty());
  EXPECT_EQ(result.poses, open(drive));
}

TEST(LoopClosing, LooksThatHardlySeeAnythingAreNotBelieved) {
  BlockDrive drive(kKeyframes, 6);
  const std::size_t all = closed(drive).loops.size();
  ASSERT_GT(all, 50u);
  for (Loop& loop : drive.loops) loop.probability = 0.001;
  EXPECT_TRUE(closed(drive).loops.empty());
  // Those that see a lot are not outvoted by those that do not.
  BlockDrive mixed(kKeyframes, 6);
  for (const Loop& right : closed(drive = mixed).loops)
    for (std::size_t i = 0; i < 2; ++i) {
      Loop vague = right;
      vague.look = mixed.loops.size();
      vague.edge.T_from_to.pose.x_m += 0.3 + 0.01 * static_cast<double>(mixed.loops.size() % 50);
      vague.probability = 0.01;
      mixed.loops.push_back(vague);
    }
  EXPECT_GT(closed(mixed).loops.size(), 9 * all / 10);
}

TEST(LoopClosing, LooksThatAgreeOnWhatTheDriveDoesNotAllowAreRefused) {
  BlockDrive drive(kKeyframes, 3);
  drive.loops.clear();
  drive.forge(10, 40, {5.0, 3.0, 0.0});
  drive.forge(14, 44, {5.0, 3.0, 0.0});
  const ClosedDrive result = closed(drive);
  EXPECT_TRUE(result.loops.empty());
  EXPECT_EQ(result.refused.size(), 6u);
  EXPECT_EQ(result.poses, open(drive));
}

TEST(LoopClosing, OfTwoPlacesThatALookNamesTheOneIsTakenThatOthersAgreeWith) {
  BlockDrive drive(kKeyframes, 4);
  std::vector<Loop> both;
  for (const Loop& right : drive.loops) {
    Loop wrong = right;
    wrong.edge.T_from_to.pose.x_m += 0.5 + 0.1 * static_cast<double>(right.look % 7);
    both.push_back(wrong);
    both.push_back(right);
  }
  const ClosedDrive right = closed(drive);
  drive.loops = both;
  const ClosedDrive result = closed(drive);
  ASSERT_GT(result.loops.size(), 50u);
  for (const Loop& loop : result.loops)
    EXPECT_LT(std::abs(miss(loop.edge, drive.truth[loop.edge.from], drive.truth[loop.edge.to]).x()),
              0.2);
  EXPECT_LE(rmse_m(result.poses, drive.truth), 1.1 * rmse_m(right.poses, drive.truth));
}

TEST(LoopClosing, TheFirstKeyframeStaysWhereItWas) {
  const BlockDrive drive(kKeyframes, 5);
  const Pose2 first{3.0, -2.0, 1.0};
  const ClosedDrive result =
      close_loops(PoseTree(kKeyframes, drive.steps), drive.steps, drive.loops, first);
  ASSERT_FALSE(result.loops.empty());
  EXPECT_LT(distance_m(result.poses.front(), first), 1e-9);
}

}  // namespace
}  // namespace voxlist::mapping
