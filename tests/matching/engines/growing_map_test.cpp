// What was made of a map that has grown since, or lost something, gives the same as what is made
// anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/matching/synthetic_room.h"
#include "voxlist/matching/counting/window_map.h"
#include "voxlist/matching/engines/matcher.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::matching {
namespace {

constexpr CellRectangle kGround{-50, -40, 70, 60};

void expect_equal(const WindowMap& grown, const WindowMap& fresh) {
  const CellRectangle part{-32, 0, 32, 32};
  for (const CellRectangle& r : {kGround, part}) {
    EXPECT_EQ(grown.count(r).cells, fresh.count(r).cells);
    EXPECT_EQ(grown.count(r).occupied, fresh.count(r).occupied);
  }
  const std::int32_t end_z = fresh.lowest_layer() + fresh.layers();
  for (std::int32_t z = fresh.lowest_layer(); z < end_z; ++z) {
    const bool known = z >= grown.lowest_layer() && z < grown.lowest_layer() + grown.layers();
    for (std::int32_t y = kGround.low_y; y + WindowMap::kTile <= kGround.end_y; ++y)
      for (std::int32_t x = kGround.low_x; x + WindowMap::kTile <= kGround.end_x; ++x)
        ASSERT_EQ(known ? grown.tile(grown.place(x, y, z)) : 0, fresh.tile(fresh.place(x, y, z)))
            << x << ' ' << y << ' ' << z;
  }
}

WindowMap holding(const VoxelMap& map, const CellRectangle& ground) {
  WindowMap window(map);
  window.hold(ground);
  return window;
}

TEST(WindowMap, GrowsToWhatItWouldBeAnew) {
  std::mt19937 random(1);
  VoxelMap map;
  const auto grow = [&](int voxels, std::int32_t height) {
    std::vector<Voxel> blocks;
    for (int i = 0; i < voxels; ++i) {
      const auto between = [&](std::int32_t low, std::int32_t high) {
        return low + static_cast<std::int32_t>(random() % static_cast<unsigned>(high - low));
      };
      // Some lie beyond the ground.
      const Voxel v{between(-300, 400), between(-250, 350), between(0, height)};
      if (map.insert(v)) blocks.push_back(block_of(v));
    }
    return blocks;
  };
  grow(500, 40);
  WindowMap window = holding(map, kGround);
  // The last ones are higher than there was room for.
  for (const std::int32_t height : {56, 56, 40, 56, 40, 200}) {
    window.map_changed(grow(100, height));
    window.hold(kGround);
    expect_equal(window, holding(map, kGround));
  }
}

TEST(WindowMap, LosesToWhatItWouldBeAnew) {
  std::mt19937 random(3);
  const auto between = [&](int low, int high) {
    return low + static_cast<std::int32_t>(random() % static_cast<unsigned>(high - low));
  };
  for (const int doublings : {0, 2}) {
    VoxelMap map;
    for (int i = 0; i < 4000; ++i)
      map.insert({between(-300, 400), between(-250, 350), between(0, 60)});
    WindowMap window(map, doublings);
    window.hold(kGround);
    for (int round = 0; round < 5; ++round) {
      std::vector<Voxel> changed;
      for (int i = 0; i < 200; ++i) {
        const Voxel at = map.block_position(random() % map.block_count());
        VoxelBlock bits = *map.find_block(at);
        if (i % 4 == 0) bits = {};
        for (std::uint64_t& word : bits) word &= random();
        if (map.set_block(at, bits)) changed.push_back(at);
      }
      ASSERT_FALSE(changed.empty());
      window.map_changed(changed);
      window.hold(kGround);
      WindowMap fresh(map, doublings);
      fresh.hold(kGround);
      expect_equal(window, fresh);
    }
  }
}

TEST(WindowMap, HoldsOneGroundAfterAnotherAsIfItWereTheFirst) {
  std::mt19937 random(2);
  VoxelMap map;
  for (int i = 0; i < 20'000; ++i) {
    const auto between = [&](int low, int high) {
      return low + static_cast<std::int32_t>(random() % static_cast<unsigned>(high - low));
    };
    map.insert({between(-2000, 300), between(-300, 300), between(0, 60)});
  }
  WindowMap window(map);
  // Near by, overlapping, far away and back.
  for (const std::int32_t x : {0, 100, -400, 40, 0}) {
    CellRectangle ground = kGround;
    ground.low_x += x;
    ground.end_x += x;
    window.hold(ground);
    window.hold(kGround);
    expect_equal(window, holding(map, kGround));
  }
}

TEST(WindowMap, CountsTheSameCellsWhateverElseItHolds) {
  const VoxelMap map = synthetic_room(6.0, 5.0, {2.5, 2.0, 0.7}, 10, 2).map;
  const CellRectangle part{0, 0, 32, 64};
  const WindowMap::Count few = holding(map, part).count(part),
                         of_many = holding(map, {-200, -200, 200, 200}).count(part);
  EXPECT_EQ(few.cells, of_many.cells);
  EXPECT_EQ(few.occupied, of_many.occupied);
  EXPECT_GT(few.occupied, 0);
}

void expect_equal(const Match& a, const Match& b) {
  EXPECT_FALSE(a.modes.empty());
  ASSERT_EQ(a.modes.size(), b.modes.size());
  for (std::size_t i = 0; i < a.modes.size(); ++i) {
    EXPECT_EQ(a.modes[i].pose, b.modes[i].pose);
    EXPECT_EQ(a.modes[i].covariance, b.modes[i].covariance);
    EXPECT_EQ(a.modes[i].inlier_ratio, b.modes[i].inlier_ratio);
    EXPECT_EQ(a.modes[i].overlap_ratio, b.modes[i].overlap_ratio);
    EXPECT_EQ(a.modes[i].evidence, b.modes[i].evidence);
  }
  EXPECT_EQ(a.significance_log10, b.significance_log10);
  EXPECT_EQ(a.poses_examined, b.poses_examined);
}

// A scan from somewhere in the room.
Cloud seen_from(const Pose2& pose) {
  Cloud cloud;
  cloud.points = synthetic_room(6.0, 5.0, pose, 5000, 1).scan;
  cloud.origins.assign(cloud.points.size(), Eigen::Vector3f(0.0F, 0.0F, 0.5F));
  return cloud;
}

// Poses on the way through the room: each sees walls that those before it saw from elsewhere.
Pose2 on_the_way(int i) { return {1.0 + 0.6 * i, 1.5 + 0.2 * i, 0.5 * i}; }

TEST(Matcher, MatchesInAGrownMapAsInANewOne) {
  OccupancyMap map;
  add_scan(seen_from(on_the_way(0)), to_pose3(on_the_way(0)), 2.5, map);
  const auto grown = make_matcher(map, {});
  for (int i = 1; i < 6; ++i) {
    const Pose2 pose = on_the_way(i);
    const Cloud cloud = seen_from(pose);
    const PreparedScan scan(cloud);
    const auto fresh = make_matcher(map, {});
    const PoseWindow window{pose * Pose2{0.1, -0.1, 0.05}, 0.4, 0.4, 0.3};
    expect_equal(grown->match(scan, window), fresh->match(scan, window));
    expect_equal(grown->match(scan, std::nullopt), fresh->match(scan, std::nullopt));
    grown->map_changed(add_scan(cloud, to_pose3(pose), i % 2 == 0 ? 100.0 : 2.0, map));
  }
}

// Takes every third block's voxels that a plane cuts off.
ChangedBlocks carve(OccupancyMap& map, int from) {
  ChangedBlocks changed;
  changed.from = map.revision();
  for (std::size_t i = static_cast<std::size_t>(from); i < map.occupied.block_count(); i += 3) {
    const Voxel at = map.occupied.block_position(i);
    VoxelBlock bits = map.occupied.block(i);
    for (std::uint64_t& word : bits) word &= 0x0f0f0f0f0f0f0f0f;
    if (map.occupied.set_block(at, bits)) changed.occupied.push_back(at);
  }
  std::sort(changed.occupied.begin(), changed.occupied.end());
  changed.to = map.revision();
  return changed;
}

TEST(Matcher, MatchesInAMapThatLostSomethingAsInANewOne) {
  OccupancyMap map;
  for (int i = 0; i < 6; ++i) add_scan(seen_from(on_the_way(i)), to_pose3(on_the_way(i)), 9.0, map);
  const auto carved = make_matcher(map, {});
  const Pose2 pose = on_the_way(2);
  const Cloud cloud = seen_from(pose);
  const PreparedScan scan(cloud);
  const PoseWindow window{pose * Pose2{0.1, -0.1, 0.05}, 0.4, 0.4, 0.3};
  for (int i = 0; i < 3; ++i) {
    carved->match(scan, window);
    const ChangedBlocks changed = carve(map, i);
    ASSERT_FALSE(changed.occupied.empty());
    carved->map_changed(changed);
    const auto fresh = make_matcher(map, {});
    expect_equal(carved->match(scan, window), fresh->match(scan, window));
    expect_equal(carved->match(scan, std::nullopt), fresh->match(scan, std::nullopt));
  }
}

TEST(Matcher, TheFilterToo) {
  OccupancyMap map;
  add_scan(seen_from(on_the_way(0)), to_pose3(on_the_way(0)), 100.0, map);
  MatcherConfig config;
  config.engine = Engine::kParticleFilter;
  const auto grown = make_matcher(map, config);
  for (int i = 1; i < 3; ++i) {
    const Cloud cloud = seen_from(on_the_way(i));
    const PreparedScan scan(cloud);
    const PoseWindow window{on_the_way(i), 0.2, 0.2, 0.1};
    expect_equal(grown->match(scan, window), make_matcher(map, config)->match(scan, window));
    grown->map_changed(add_scan(cloud, to_pose3(on_the_way(i)), 100.0, map));
  }
}

TEST(EvidenceMap, WeighsInAGrownMapAsInANewOne) {
  OccupancyMap map;
  EvidenceMap grown(map);
  for (int i = 0; i < 5; ++i) {
    const Cloud scan = seen_from(on_the_way(i));
    grown.map_changed(add_scan(scan, to_pose3(on_the_way(i)), 1.0 + i, map));
    const PreparedScan prepared(scan);
    const auto& rays = prepared.few_rays();
    for (const Pose2& off : {Pose2{}, Pose2{0.5, 0.3, 1.0}}) {
      const Pose2 pose = on_the_way(i) * off;
      EXPECT_EQ(grown.at(pose, rays), EvidenceMap(map).at(pose, rays));
    }
    EXPECT_GT(grown.at(on_the_way(i), rays).hits, 0);
  }
}

void expect_same_track(const Localisation& a, const Localisation& b) {
  ASSERT_TRUE(b.tracking());
  EXPECT_EQ(a.modes.front().T_map_base, b.modes.front().T_map_base);
  EXPECT_EQ(a.modes.front().covariance, b.modes.front().covariance);
  EXPECT_EQ(a.significance_log10, b.significance_log10);
}

TEST(Localiser, TracksInAGrownMapAsInANewOneWhetherItIsToldOrNot) {
  OccupancyMap map;
  // The second one is never told that the map grew, the third one only now and then.
  Localiser grown(map), fresh(map), told_of_some(map);
  for (int i = 0; i < 6; ++i) {
    Cloud scan = seen_from(on_the_way(i));
    scan.utime_us = i * 1'000'000;
    const Localisation a = grown.localise(scan);
    ASSERT_TRUE(a.tracking());
    expect_same_track(a, fresh.localise(scan));
    expect_same_track(a, told_of_some.localise(scan));
    const Pose3 T_map_base = to_pose3(a.modes.front().T_map_base);
    const ChangedBlocks changed = add_scan(scan, T_map_base, 2.5, map);
    grown.map_changed(changed);
    if (i % 2 == 1) told_of_some.map_changed(changed);
  }
}

TEST(Localiser, NoticesThatItsMapWasReplaced) {
  OccupancyMap map;
  const Cloud scan = seen_from(on_the_way(0));
  add_scan(scan, to_pose3(on_the_way(0)), 100.0, map);
  Localiser localiser(map);
  EXPECT_FALSE(localiser.locate(scan).modes.empty());
  map = {VoxelMap(0.04), VoxelMap(kPassedResolution_m)};
  const Pose2 moved = Pose2{7.0, -3.0, 0.4} * on_the_way(0);
  add_scan(scan, to_pose3(moved), 100.0, map);
  const Localisation found = localiser.locate(scan);
  ASSERT_FALSE(found.modes.empty());
  EXPECT_LT(distance_m(found.modes.front().T_map_base, moved), 0.05);
}

}  // namespace
}  // namespace voxlist::matching
