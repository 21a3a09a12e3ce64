#include "voxlist/mapping/pieces/piece.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/temporary_folder.h"

namespace voxlist::mapping {
namespace {

// A wall 2 m ahead, as wide as it is new.
Cloud wall(std::int64_t utime_us, float width_m) {
  Cloud cloud;
  cloud.utime_us = utime_us;
  for (float y = 0.0F; y < width_m; y += 0.02F)
    for (float z = 0.5F; z < 1.5F; z += 0.02F) cloud.points.emplace_back(2.0F, y, z);
  return cloud;
}

matching::PoseMode at(double x_m) {
  matching::PoseMode mode;
  mode.T_map_base.x_m = x_m;
  return mode;
}

TEST(Piece, MakesItsMapAnewWhereKeyframesAreMoved) {
  const test::TemporaryFolder folder;
  KeyframeSpool spool(folder.path());
  Piece piece({}, MapBuilder(), spool);
  ASSERT_TRUE(piece.take(wall(0, 1.0F), at(0.0), std::nullopt));
  ASSERT_TRUE(piece.take(wall(1'000'000, 3.0F), at(4.0), std::nullopt));
  ASSERT_FALSE(piece.take(wall(1'200'000, 3.0F), at(4.1), std::nullopt));

  const Pose2 moved{3.0, 1.0, std::numbers::pi / 2};
  piece.move_keyframes({Pose3::Identity(), to_pose3(moved)});

  MapBuilder fresh;
  fresh.add({Pose3::Identity(), wall(0, 1.0F)});
  fresh.add({to_pose3(moved), wall(1'000'000, 3.0F)});
  EXPECT_EQ(piece.builder().map().occupied.hash(), fresh.map().occupied.hash());
  ASSERT_EQ(piece.trajectory().size(), 3u);
  EXPECT_LT(distance_m(to_pose2(piece.trajectory()[0].pose), {}), 1e-9);
  EXPECT_LT(distance_m(to_pose2(piece.trajectory()[1].pose), moved), 1e-9);
  EXPECT_LT(distance_m(to_pose2(piece.trajectory()[2].pose), {3.0, 1.1, 0.0}), 1e-9);
  ASSERT_EQ(piece.keyframes().size(), 2u);
  EXPECT_LT(distance_m(to_pose2(piece.keyframes()[1].T_map_base), moved), 1e-9);
}

TEST(Piece, MovesAScanWithAKeyframeOfItsOwnSession) {
  const test::TemporaryFolder folder;
  KeyframeSpool spool(folder.path());
  Piece piece({}, MapBuilder(), spool), other({}, MapBuilder(), spool);
  piece.add(wall(0, 1.0F), Pose3::Identity());
  other.add(wall(0, 3.0F), Pose3::Identity());
  piece.begin_session();
  piece.join(other, {4.0, 0.0, 0.0});
  EXPECT_EQ(piece.first_session(), 1u);

  const Pose2 moved{4.5, 0.0, 0.0};
  piece.move_keyframes({Pose3::Identity(), to_pose3(moved)});

  ASSERT_EQ(piece.trajectory().size(), 2u);
  EXPECT_LT(distance_m(to_pose2(piece.trajectory()[0].pose), {}), 1e-9);
  EXPECT_LT(distance_m(to_pose2(piece.trajectory()[1].pose), moved), 1e-9);
}

}  // namespace
}  // namespace voxlist::mapping
