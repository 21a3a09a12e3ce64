#include "voxlist/matching/localisation/hypotheses.h"

#include <gtest/gtest.h>

namespace voxlist::matching {
namespace {

constexpr double kUnseen = 0.78, kAnything = 1.0;

PoseMode candidate(const Pose2& pose, double support) {
  PoseMode mode;
  mode.T_map_base = pose;
  mode.support = {support, support};
  return mode;
}

TEST(Hypotheses, BeginWithoutAny) {
  Hypotheses hypotheses;
  EXPECT_TRUE(hypotheses.empty());
  EXPECT_TRUE(hypotheses.modes().empty());
  hypotheses.update({}, kUnseen);
  EXPECT_TRUE(hypotheses.modes().empty());
}

TEST(Hypotheses, MoveWithTheRobot) {
  Hypotheses hypotheses;
  hypotheses.update({candidate({1.0, 2.0, 0.0}, 0.9), candidate({5.0, 2.0, 3.0}, 0.9)}, kUnseen);
  hypotheses.move({0.5, 0.0, 0.1});
  EXPECT_EQ(hypotheses.poses().at(0).T_map_base, (Pose2{1.5, 2.0, 0.1}));
}

// Two rooms alike but for a small thing, which a scan sees only a little of.
TEST(Hypotheses, TellAlikePosesApartOverSeveralScans) {
  Hypotheses hypotheses;
  Pose2 right{0.0, 0.0, 0.0}, wrong{10.0, 0.0, 0.0};
  double first = 0.0;
  for (int scan = 0; scan < 8; ++scan) {
    if (scan > 0) {
      right.x_m += 0.5, wrong.x_m += 0.5;
      hypotheses.move({0.5, 0.0, 0.0});
    }
    hypotheses.update({candidate(wrong, 0.985), candidate(right, 0.99)}, kUnseen);
    if (scan == 0) first = hypotheses.modes().front().probability;
  }
  EXPECT_LT(first, 0.95);
  EXPECT_EQ(hypotheses.modes().front().T_map_base, right);
  EXPECT_GT(hypotheses.modes().front().probability, 0.99);
}

TEST(Hypotheses, LearnNothingMoreFromStandingStill) {
  Hypotheses hypotheses;
  const std::vector<PoseMode> candidates{candidate({0.0, 0.0, 0.0}, 0.99),
                                         candidate({10.0, 0.0, 0.0}, 0.97)};
  hypotheses.update(candidates, kUnseen);
  const double first = hypotheses.modes().front().probability;
  for (int scan = 0; scan < 20; ++scan) {
    hypotheses.move({});
    hypotheses.update(candidates, kUnseen);
  }
  EXPECT_DOUBLE_EQ(hypotheses.modes().front().probability, first);
}

// However long it was elsewhere.
TEST(Hypotheses, BelieveARobotThatComesBack) {
  Hypotheses hypotheses;
  Pose2 pose;
  const auto see = [&](double support) {
    hypotheses.move({0.5, 0.0, 0.0});
    pose.x_m += 0.5;
    hypotheses.update({candidate(pose, support)}, kUnseen);
    return hypotheses.modes().front().probability;
  };
  for (int scan = 0; scan < 40; ++scan) EXPECT_LT(see(0.6), 0.01);
  EXPECT_LT(see(0.98), 0.5) << "one scan may err";
  for (int scan = 0; scan < 7; ++scan) see(0.98);
  EXPECT_GT(see(0.98), 0.996);
}

TEST(Hypotheses, KeepAlikeHypothesesEqualHoweverFarTheRobotDrives) {
  Hypotheses hypotheses;
  double x_m = 0.0;
  for (int scan = 0; scan < 10; ++scan, x_m += 0.5) {
    std::vector<PoseMode> rooms;
    for (int room = 0; room < 8; ++room) rooms.push_back(candidate({x_m, 10.0 * room, 0.0}, 0.99));
    if (scan > 0) hypotheses.move({0.5, 0.0, 0.0});
    hypotheses.update(rooms, kUnseen);
  }
  ASSERT_EQ(hypotheses.modes().size(), 8U);
  for (const PoseMode& mode : hypotheses.modes()) EXPECT_LT(mode.probability, 0.13);
}

TEST(Hypotheses, GiveUpPosesThatNoScanFindsAgain) {
  Hypotheses hypotheses;
  hypotheses.update({candidate({0.0, 0.0, 0.0}, 0.9), candidate({10.0, 0.0, 0.0}, 0.9)}, kUnseen);
  hypotheses.move({1.0, 0.0, 0.0});
  hypotheses.update({candidate({11.0, 0.0, 0.0}, 0.9)}, kUnseen);
  ASSERT_EQ(hypotheses.modes().size(), 1U);
  EXPECT_EQ(hypotheses.modes().front().T_map_base, (Pose2{11.0, 0.0, 0.0}));
}

// After a search that did not end.
TEST(Hypotheses, DoNotLetANewcomerPassForOneThatWasAlwaysThere) {
  Hypotheses hypotheses;
  hypotheses.update({candidate({0.0, 0.0, 0.0}, 0.97), candidate({10.0, 0.0, 0.0}, 0.9)},
                    kAnything);
  hypotheses.move({0.5, 0.0, 0.0});
  hypotheses.update({candidate({0.5, 0.0, 0.0}, 0.97), candidate({30.0, 0.0, 0.0}, 0.97)},
                    kAnything);
  EXPECT_EQ(hypotheses.modes().front().T_map_base, (Pose2{0.5, 0.0, 0.0}));
  EXPECT_GT(hypotheses.modes().front().probability, 3.0 * hypotheses.modes().at(1).probability);
}

TEST(Hypotheses, DistrustNewcomersThatTheSearchBeforeWouldHaveFound) {
  for (const double unseen : {kUnseen, kAnything}) {
    Hypotheses hypotheses;
    hypotheses.update({candidate({0.0, 0.0, 0.0}, 0.9)}, unseen);
    hypotheses.move({0.5, 0.0, 0.0});
    hypotheses.update({candidate({0.5, 0.0, 0.0}, 0.9), candidate({30.0, 0.0, 0.0}, 0.9)}, unseen);
    const PoseMode first = hypotheses.modes().at(0), newcomer = hypotheses.modes().at(1);
    EXPECT_EQ(first.T_map_base, (Pose2{0.5, 0.0, 0.0}));
    if (unseen == kUnseen)
      EXPECT_GT(first.probability, 1000.0 * newcomer.probability);
    else
      EXPECT_NEAR(first.probability, newcomer.probability, 1e-9);
  }
}

TEST(Hypotheses, CountTheSamePoseOnce) {
  Hypotheses hypotheses;
  hypotheses.update({candidate({0.0, 0.0, 0.0}, 0.9), candidate({0.1, 0.0, 0.01}, 0.91)}, kUnseen);
  ASSERT_EQ(hypotheses.modes().size(), 1U);
  EXPECT_EQ(hypotheses.modes().front().T_map_base.x_m, 0.1);
}

}  // namespace
}  // namespace voxlist::matching
