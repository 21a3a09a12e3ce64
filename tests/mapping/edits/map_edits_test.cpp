#include "voxlist/mapping/edits/map_edits.h"

#include <gmock/gmock.h>

#include <limits>
#include <numbers>

#include "voxlist/voxels/edits/edit_limits.h"

namespace voxlist::mapping {
namespace {

using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Eigen::AlignedBox3d box_at(double x_m, double edge_m = 1.0) {
  return {Eigen::Vector3d(x_m, 0.0, 0.0), Eigen::Vector3d(x_m + edge_m, edge_m, edge_m)};
}

// Keyframes 10 m from each other along x.
std::vector<StampedPose3> drive() {
  std::vector<StampedPose3> poses;
  for (int i = 0; i < 4; ++i) poses.push_back({100 + i, to_pose3({10.0 * i, 0.0, 0.3 * i})});
  return poses;
}

TEST(MapEdits, HoldOnToTheNearestKeyframe) {
  MapEdits edits;
  EXPECT_EQ(edits.add(EditKind::kErase, box_at(21.0), drive()), 1);
  EXPECT_EQ(edits.edits[0].keyframe, 2U);
  EXPECT_EQ(edits.edits[0].utime_us, 102);
  EXPECT_EQ(edits.edits[0].T_map_keyframe, to_pose2(drive()[2].pose));
  EXPECT_EQ(edits.changes, 1);
}

TEST(MapEdits, StayWhereTheyAreInEveryBitWhereTheirKeyframeDoes) {
  MapEdits edits;
  edits.add(EditKind::kErase, box_at(21.0), drive());
  auto moved = drive();
  moved[1].pose = to_pose3({5.0, 5.0, 1.0});
  EXPECT_EQ(edits.placed(moved)[0].T_map_box, Pose2{});
}

TEST(MapEdits, GoWhereTheirKeyframeGoes) {
  MapEdits edits;
  edits.add(EditKind::kErase, box_at(21.0), drive());
  auto moved = drive();
  const Pose2 T{3.0, -2.0, std::numbers::pi / 2};
  moved[2].pose = to_pose3(T) * moved[2].pose;
  const PlacedBox placed = edits.placed(moved)[0];
  EXPECT_TRUE(placed.contains(T * Eigen::Vector3d(21.1, 0.5, 0.9)));
  EXPECT_FALSE(placed.contains(T * Eigen::Vector3d(20.9, 0.5, 0.9)));
  EXPECT_FALSE(placed.contains(Eigen::Vector3d(21.1, 0.5, 0.9)));
}

TEST(MapEdits, FindTheirKeyframeWhereOthersWereLost) {
  MapEdits edits;
  edits.add(EditKind::kErase, box_at(21.0), drive());
  auto rest = drive();
  rest.erase(rest.begin());
  rest[1].pose = to_pose3(Pose2{20.0, 7.0, 0.6});
  EXPECT_NEAR(edits.placed(rest)[0].T_map_box.y_m, 7.0, 1e-9);
  rest.erase(rest.begin() + 1);
  EXPECT_EQ(edits.placed(rest)[0].T_map_box, Pose2{}) << "its own keyframe was lost";
}

TEST(MapEdits, AreTakenBackById) {
  MapEdits edits;
  edits.add(EditKind::kErase, box_at(0.0), drive());
  edits.add(EditKind::kKeepFree, box_at(1.0), drive());
  EXPECT_TRUE(edits.remove(1));
  EXPECT_FALSE(edits.remove(1));
  ASSERT_EQ(edits.edits.size(), 1U);
  EXPECT_EQ(edits.edits[0].id, 2);
  EXPECT_EQ(edits.add(EditKind::kErase, box_at(0.0), drive()), 3) << "an id is given once";
  EXPECT_EQ(edits.changes, 4);
}

TEST(MapEdits, RefuseWhatIsNoBoxOrTooMuch) {
  MapEdits edits;
  EXPECT_EQ(edits.refusal(box_at(0.0), drive()), "");
  EXPECT_THAT(edits.refusal(box_at(0.0), {}), HasSubstr("empty"));
  EXPECT_THAT(edits.refusal(box_at(kNaN), drive()), HasSubstr("nowhere"));
  EXPECT_THAT(edits.refusal(box_at(20'000.0), drive()), HasSubstr("beyond 10 km"));
  EXPECT_THAT(edits.refusal(box_at(0.0, -1.0), drive()), HasSubstr("edge"));
  EXPECT_THAT(edits.refusal(box_at(0.0, 101.0), drive()), HasSubstr("edge"));
  EXPECT_THAT(edits.refusal(box_at(0.0, 50.0), drive()), HasSubstr("m3"));
  MapEdit small;
  small.box = box_at(0.0, 0.1);
  edits.edits.assign(kMostEdits, small);
  EXPECT_THAT(edits.refusal(box_at(0.0), drive()), HasSubstr("10000 boxes"));
}

TEST(MapEdits, OfTwoMapsHoldOnToTheirOwnKeyframes) {
  MapEdits first, second;
  first.add(EditKind::kErase, box_at(0.0), drive());
  second.add(EditKind::kKeepBlocked, box_at(31.0), drive());
  first.append(second, 4);
  // The second map lies 100 m further along y, and its times are the same.
  auto both = drive();
  for (StampedPose3 pose : drive()) {
    pose.pose = to_pose3(Pose2{0.0, 100.0, 0.0}) * pose.pose;
    both.push_back(pose);
  }
  const auto placed = first.placed(both);
  ASSERT_EQ(placed.size(), 2U);
  EXPECT_TRUE(placed[0].contains({0.5, 0.5, 0.5}));
  EXPECT_TRUE(placed[1].contains({31.5, 100.5, 0.5}));
  EXPECT_EQ(first.edits[1].id, 2);
}

}  // namespace
}  // namespace voxlist::mapping
