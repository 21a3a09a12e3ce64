#include "voxlist/mapping/map_builder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace voxlist::mapping {
namespace {

Keyframe keyframe_at(const Pose2& pose, std::vector<Eigen::Vector3f> points) {
  Keyframe keyframe;
  keyframe.T_map_base = to_pose3(pose);
  keyframe.cloud.points = std::move(points);
  return keyframe;
}

// A wall, 2 m ahead of base.
Cloud wall() {
  Cloud cloud;
  for (int i = 0; i < 200; ++i) cloud.points.emplace_back(2.f, 0.03f * float(i), 0.5f);
  return cloud;
}

TEST(MapBuilder, WantsTheFirstCloudAndThenThoseThatMovedEnough) {
  MapBuilder builder;
  EXPECT_TRUE(builder.wants(wall(), {}));
  builder.add({to_pose3(Pose2{}), wall()});
  EXPECT_FALSE(builder.wants(wall(), {0.1, 0.1, 0.1}));
  EXPECT_TRUE(builder.wants(wall(), {0.31, 0.0, 0.0}));
  EXPECT_FALSE(builder.wants(wall(), {0.4, 0.0, 0.0})) << "only 0.09 m after the last look";
  EXPECT_TRUE(builder.wants(wall(), {0.4, 0.0, -0.25}));
}

TEST(MapBuilder, WantsNoCloudThatTellsNothingNew) {
  MapBuilder builder;
  for (const double x_m : {0.0, 1.0}) builder.add({to_pose3({x_m, 0.0, 0.0}), wall()});
  EXPECT_FALSE(builder.wants(wall(), {0.0, 0.0, 0.0}));
  EXPECT_TRUE(builder.wants(wall(), {-1.0, 0.0, 0.0})) << "the wall stands 1 m nearer now";
}

TEST(MapBuilder, WantsWhatMovedWhereNoNewsAreAskedFor) {
  MapBuilder builder({.min_news = 0.0});
  for (const double x_m : {0.0, 1.0}) builder.add({to_pose3({x_m, 0.0, 0.0}), wall()});
  EXPECT_TRUE(builder.wants(wall(), {0.0, 0.0, 0.0}));
}

TEST(MapBuilder, PutsPointsWhereTheirPoseSays) {
  MapBuilder builder;
  builder.add(keyframe_at({1.0, 2.0, 1.5707963267948966}, {{1.005f, 0.005f, 0.5f}}));
  EXPECT_EQ(builder.map().occupied.size(), 1u);
  EXPECT_TRUE(builder.map().occupied.contains(voxel_at(Eigen::Vector3d(0.995, 3.005, 0.5), 0.02)));
}

TEST(MapBuilder, LeavesOutPointsBeyondItsRangeFromTheirOrigin) {
  MapBuilder builder({.max_range_m = 5.0});
  Keyframe keyframe = keyframe_at({}, {{6.f, 0.f, 0.f}, {6.f, 1.f, 0.f}});
  keyframe.cloud.origins = {{0.f, 0.f, 0.f}, {2.f, 1.f, 0.f}};
  builder.add(keyframe);
  EXPECT_EQ(builder.map().occupied.size(), 1u);
  EXPECT_TRUE(builder.map().occupied.contains(voxel_at(Eigen::Vector3d(6.0, 1.0, 0.0), 0.02)));
}

TEST(MapBuilder, TakesPointsAtNoRangeForNoPoints) {
  MapBuilder builder;
  builder.add(keyframe_at({}, {{0.f, 0.f, 0.f}, {0.04f, 0.f, 0.f}, {0.06f, 0.f, 0.f}}));
  EXPECT_EQ(builder.map().occupied.size(), 1u);
  Keyframe keyframe = keyframe_at({}, {{2.f, 0.f, 0.f}, {0.f, 0.f, 0.f}, {3.f, 0.f, 0.f}});
  keyframe.cloud.origins = {{2.f, 0.02f, 0.f}, {0.3f, 0.f, 0.f}, {0.3f, 0.f, 0.f}};
  keyframe = builder.add(keyframe);
  EXPECT_EQ(keyframe.cloud.points, (std::vector<Eigen::Vector3f>{{3, 0, 0}}));
  EXPECT_EQ(keyframe.cloud.origins.size(), 1u);
}

// Rays of a room, from many places in it.
std::vector<Keyframe> drive() {
  std::vector<Keyframe> keyframes;
  for (int i = 0; i < 12; ++i) {
    Keyframe keyframe = keyframe_at({1.3 * i, 0.3, 0.1 * i}, {});
    keyframe.cloud.utime_us = 1000 + i;
    for (int k = 0; k < 500; ++k) {
      const float angle = 0.37F * float(k), z = 0.004F * float(k % 300 - 100);
      keyframe.cloud.points.emplace_back(3.0F * std::cos(angle), 2.0F * std::sin(angle), z);
    }
    keyframes.push_back(keyframe);
  }
  return keyframes;
}

MapBuilder made_of(const std::vector<Keyframe>& keyframes) {
  MapBuilder builder({.carve = true, .count_free = true});
  for (const Keyframe& keyframe : keyframes) builder.add(keyframe);
  return builder;
}

void expect_same(const MapBuilder& a, const MapBuilder& b) {
  EXPECT_EQ(a.map().occupied.hash(), b.map().occupied.hash());
  EXPECT_EQ(a.map().passed.hash(), b.map().passed.hash());
  EXPECT_EQ(a.free_space().occupied.hash(), b.free_space().occupied.hash());
  EXPECT_EQ(a.free_space().passed.hash(), b.free_space().passed.hash());
  ASSERT_EQ(a.poses().size(), b.poses().size());
  for (std::size_t i = 0; i < a.poses().size(); ++i) {
    EXPECT_EQ(a.poses()[i].utime_us, b.poses()[i].utime_us);
    EXPECT_EQ(a.poses()[i].pose.matrix(), b.poses()[i].pose.matrix());
  }
}

// Few are moved in their places, most are made anew.
TEST(MapBuilder, IsAsIfKeyframesHadAlwaysBeenWhereTheyAreMovedTo) {
  for (const std::size_t first : {11u, 9u, 1u}) {
    std::vector<Keyframe> keyframes = drive();
    MapBuilder builder = made_of(keyframes);
    std::vector<std::optional<Pose3>> poses;
    for (std::size_t i = 0; i < keyframes.size(); ++i) {
      if (i >= first) keyframes[i].T_map_base = to_pose3({1.2 * double(i), 1.0, 0.5});
      poses.emplace_back(keyframes[i].T_map_base);
    }
    const std::uint64_t before = builder.map().occupied.hash();
    std::size_t read = 0;
    builder.move(poses, [&](std::size_t i) {
      ++read;
      return keyframes[i].cloud;
    });
    EXPECT_NE(builder.map().occupied.hash(), before);
    EXPECT_GE(read, keyframes.size());
    expect_same(builder, made_of(keyframes));
  }
}

TEST(MapBuilder, IsAsIfAKeyframeHadNeverBeenInOnceItIsTakenOut) {
  std::vector<Keyframe> keyframes = drive();
  MapBuilder builder = made_of(keyframes);
  std::vector<std::optional<Pose3>> poses;
  for (const Keyframe& keyframe : keyframes) poses.emplace_back(keyframe.T_map_base);
  poses[4].reset();
  builder.move(poses, [&](std::size_t i) { return keyframes[i].cloud; });
  keyframes.erase(keyframes.begin() + 4);
  expect_same(builder, made_of(keyframes));
}

TEST(MapBuilder, ReadsNothingWhereNothingMoves) {
  const std::vector<Keyframe> keyframes = drive();
  MapBuilder builder = made_of(keyframes);
  std::vector<std::optional<Pose3>> poses;
  for (const Keyframe& keyframe : keyframes) poses.emplace_back(keyframe.T_map_base);
  builder.move(poses, [](std::size_t) -> Cloud {
    ADD_FAILURE();
    return {};
  });
  expect_same(builder, made_of(keyframes));
}

TEST(MapBuilder, NamesTheBlocksThatAKeyframeChanged) {
  MapBuilder builder;
  builder.add(keyframe_at({}, {{0.11f, 0.01f, 0.01f}, {5.01f, 0.01f, 0.01f}}));
  EXPECT_EQ(builder.changed_blocks().occupied, (std::vector<Voxel>{{0, 0, 0}, {31, 0, 0}}));
  builder.add(keyframe_at({}, {{0.11f, 0.01f, 0.01f}, {5.03f, 0.01f, 0.01f}}));
  EXPECT_EQ(builder.changed_blocks().occupied, (std::vector<Voxel>{{31, 0, 0}}));
}

// A box of each kind, in what the drive sees.
MapEdits edits_of(const std::vector<Keyframe>& keyframes) {
  std::vector<StampedPose3> poses;
  for (const Keyframe& k : keyframes) poses.push_back({k.cloud.utime_us, k.T_map_base});
  MapEdits edits;
  for (const auto kind : {EditKind::kErase, EditKind::kKeepFree, EditKind::kKeepBlocked}) {
    const Eigen::Vector3d low(5.0 * double(edits.edits.size()), -2.0, -1.0);
    edits.add(kind, {low, low + Eigen::Vector3d(4.0, 4.0, 1.5)}, poses);
  }
  return edits;
}

MapBuilder made_and_edited(const std::vector<Keyframe>& keyframes, const MapEdits& edits) {
  MapBuilder builder = made_of(keyframes);
  builder.edit(edits);
  return builder;
}

TEST(MapBuilder, HasEditsLastWhateverIsAddedAfterwards) {
  const std::vector<Keyframe> keyframes = drive();
  const MapEdits edits = edits_of(keyframes);
  MapBuilder builder = made_and_edited({keyframes.begin(), keyframes.begin() + 6}, edits);
  for (std::size_t i = 6; i < keyframes.size(); ++i) {
    const MapRevision before = builder.map().revision();
    builder.add(keyframes[i]);
    EXPECT_EQ(builder.changed_blocks().from, before);
    EXPECT_EQ(builder.changed_blocks().to, builder.map().revision());
  }
  expect_same(builder, made_and_edited(keyframes, edits));
  EXPECT_LT(builder.map().occupied.size(), made_of(keyframes).map().occupied.size());
}

TEST(MapBuilder, MovesEditsWithTheirKeyframes) {
  for (const std::size_t first : {9u, 1u}) {
    std::vector<Keyframe> keyframes = drive();
    const MapEdits edits = edits_of(keyframes);
    MapBuilder builder = made_and_edited(keyframes, edits);
    const OccupancyMap before = builder.map();
    std::vector<std::optional<Pose3>> poses;
    for (std::size_t i = 0; i < keyframes.size(); ++i) {
      if (i >= first) keyframes[i].T_map_base = to_pose3({0.5, 1.0, 0.4}) * keyframes[i].T_map_base;
      poses.emplace_back(keyframes[i].T_map_base);
    }
    builder.move(poses, [&](std::size_t i) { return keyframes[i].cloud; });
    expect_same(builder, made_and_edited(keyframes, edits));
    EXPECT_EQ(builder.changed_blocks().occupied, difference(before, builder.map()).occupied);
  }
}

TEST(MapBuilder, KeepsItsEditsWhereItTakesAMovedMap) {
  std::vector<Keyframe> keyframes = drive();
  const MapEdits edits = edits_of(keyframes);
  MapBuilder builder = made_and_edited(keyframes, edits);
  const OccupancyMap before = builder.map();
  for (Keyframe& k : keyframes) k.T_map_base = to_pose3({0.5, 1.0, 0.4}) * k.T_map_base;
  builder.move_to(made_of(keyframes), {0.5, 1.0, 0.4});
  expect_same(builder, made_and_edited(keyframes, edits));
  EXPECT_EQ(builder.changed_blocks().occupied, difference(before, builder.map()).occupied);
}

TEST(MapBuilder, IsAsItWasOnceItsEditsAreTakenBack) {
  const std::vector<Keyframe> keyframes = drive();
  MapBuilder builder = made_and_edited(keyframes, edits_of(keyframes));
  const OccupancyMap before = builder.map();
  builder.edit({});
  expect_same(builder, made_of(keyframes));
  EXPECT_GT(builder.changed_blocks().occupied.size(), 10U);
  EXPECT_EQ(builder.changed_blocks().occupied, difference(before, builder.map()).occupied);
}

}  // namespace
}  // namespace voxlist::mapping
