#include "voxlist/voxels/voids/carved_map.h"

#include <gtest/gtest.h>

#include <cmath>

namespace voxlist {
namespace {

// A box of the world, in the map.
struct Thing {
  Eigen::Vector3d low, high;
};

// The way (m) along a ray into a box from outside; infinity where it misses.
double way_to(const Thing& thing, const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
  const Eigen::Array3d a = (thing.low - from).array() / along.array();
  const Eigen::Array3d b = (thing.high - from).array() / along.array();
  const double enter = a.min(b).maxCoeff(), leave = a.max(b).minCoeff();
  return enter > 0.0 && enter <= leave ? enter : HUGE_VAL;
}

// To the walls of a room of 8 x 6 x 2.6 m, from inside.
double way_to_walls(const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
  const Eigen::Array3d a = (Eigen::Vector3d(-4.0, -3.0, 0.0) - from).array() / along.array();
  const Eigen::Array3d b = (Eigen::Vector3d(4.0, 3.0, 2.6) - from).array() / along.array();
  return a.max(b).minCoeff();
}

constexpr double kEye_m = 1.0;

// A scan of 20,000 rays, evenly all round, from a place in the room.
Cloud scan_of(const std::vector<Thing>& things, const Pose2& pose) {
  constexpr int kRays = 20'000;
  Cloud cloud;
  const Eigen::Vector3d from(pose.x_m, pose.y_m, kEye_m);
  for (int i = 0; i < kRays; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kRays, angle = 2.399963229728653 * i;
    const Eigen::Vector3d along(std::sqrt(1.0 - z * z) * std::cos(angle + pose.yaw_rad),
                                std::sqrt(1.0 - z * z) * std::sin(angle + pose.yaw_rad), z);
    double way_m = way_to_walls(from, along);
    for (const Thing& thing : things) way_m = std::min(way_m, way_to(thing, from, along));
    cloud.points.push_back(
        (to_pose3(pose).inverse() * Eigen::Vector3d(from + way_m * along)).cast<float>());
  }
  cloud.origins.assign(cloud.points.size(), Eigen::Vector3f(0.0F, 0.0F, float{kEye_m}));
  return cloud;
}

// To and fro beside the middle of the room, never twice in one place.
Pose2 looking_from(int i) {
  return {-1.0 + 0.3 * (i % 6) + 0.007 * i, -1.2 + 0.1 * (i % 5) + 0.003 * i, 0.1 * i};
}

class Robot {
 public:
  explicit Robot(bool carve = true) : map(CarvingConfig{.carve = carve}) {}

  ChangedBlocks look(const std::vector<Thing>& things) {
    const Pose2 pose = looking_from(looks_++);
    return map.add({to_pose3(pose), scan_of(things, pose)});
  }

  void look(const std::vector<Thing>& things, int times) {
    for (int i = 0; i < times; ++i) look(things);
  }

  CarvedMap map;

 private:
  int looks_ = 0;
};

std::size_t voxels_in(const VoxelMap& map, const Thing& thing) {
  std::size_t count = 0;
  map.for_each_voxel([&](const Voxel& v) {
    const Eigen::Array3d p = center(v, map.resolution_m()).array();
    count += (p > thing.low.array() - 0.05).all() && (p < thing.high.array() + 0.05).all();
  });
  return count;
}

// Above the floor by more than a cell.
const Thing kPerson{{0.8, 0.5, 0.3}, {1.1, 0.9, 1.8}};
const Thing kPole{{1.63, 1.13, 0.0}, {1.67, 1.17, 2.6}};
const Thing kTableTop{{-0.61, 0.51, 0.51}, {0.61, 1.31, 0.55}};
const Thing kSign{{-2.5, 0.3, 1.9}, {-2.48, 0.9, 2.3}};

TEST(CarvedMap, LosesSomebodyWhoWalkedThrough) {
  Robot robot;
  robot.look({kPerson});
  ASSERT_GT(voxels_in(robot.map.map().occupied, kPerson), 50u);
  robot.look({}, 5);
  EXPECT_EQ(voxels_in(robot.map.map().occupied, kPerson), 0u);
}

TEST(CarvedMap, LosesSomebodyWhoStoodForAMinute) {
  Robot robot;
  robot.look({kPerson}, 60);
  const std::size_t stood = voxels_in(robot.map.map().occupied, kPerson);
  robot.look({}, 8);
  EXPECT_LT(voxels_in(robot.map.map().occupied, kPerson), stood / 100);
}

TEST(CarvedMap, HasNobodyWhoWalksWhereItWasVoid) {
  Robot robot;
  robot.look({}, 8);
  robot.look({kPerson});
  EXPECT_LT(voxels_in(robot.map.map().occupied, kPerson), 10u);
  EXPECT_GT(voxels_in(robot.map.waiting(), kPerson), 50u);
}

TEST(CarvedMap, HasWhatWasPutWhereItWasVoidAfterThreeLooks) {
  Robot robot;
  robot.look({}, 8);
  robot.look({kPerson}, 3);
  Robot fresh;
  fresh.look({kPerson}, 3);
  EXPECT_GT(voxels_in(robot.map.map().occupied, kPerson),
            voxels_in(fresh.map.map().occupied, kPerson) * 8 / 10);
}

TEST(CarvedMap, KeepsThinThings) {
  Robot robot, all(false);
  for (int i = 0; i < 40; ++i)
    for (Robot* one : {&robot, &all}) one->look({kPole, kTableTop, kSign});
  for (const Thing& thing : {kPole, kTableTop, kSign}) {
    const std::size_t hit = voxels_in(all.map.map().occupied, thing);
    ASSERT_GT(hit, 100u);
    EXPECT_GE(voxels_in(robot.map.map().occupied, thing), hit * 90 / 100);
  }
}

// The voxels that are in one map alone.
std::size_t difference(const VoxelMap& a, const VoxelMap& b) {
  std::size_t count = 0;
  a.for_each_voxel([&](const Voxel& v) { count += !b.contains(v); });
  b.for_each_voxel([&](const Voxel& v) { count += !a.contains(v); });
  return count;
}

// Rays are followed in micrometres there, and in doubles here.
TEST(CarvedMap, WithoutCarvingIsWhatAddScanMakes) {
  Robot robot(false);
  OccupancyMap plain;
  for (int i = 0; i < 3; ++i) {
    const std::vector<Thing> things = i == 0 ? std::vector{kPerson} : std::vector<Thing>{};
    const ChangedBlocks changed = robot.look(things);
    const Pose2 pose = looking_from(i);
    const ChangedBlocks wanted = add_scan(scan_of(things, pose), to_pose3(pose), 100.0, plain);
    EXPECT_EQ(changed.occupied, wanted.occupied);
    EXPECT_NEAR(double(changed.passed.size()), double(wanted.passed.size()), 2.0);
  }
  EXPECT_EQ(robot.map.map().occupied.hash(), plain.occupied.hash());
  EXPECT_GT(plain.passed.size(), 10'000u);
  EXPECT_LE(difference(robot.map.map().passed, plain.passed), plain.passed.size() / 10'000);
}

TEST(CarvedMap, TellsAllBlocksThatChanged) {
  Robot robot;
  robot.look({kPerson});
  OccupancyMap follower = robot.map.map();
  for (int i = 0; i < 6; ++i) {
    const ChangedBlocks changed = robot.look({});
    for (const Voxel& at : changed.occupied)
      follower.occupied.set_block(at, *robot.map.map().occupied.find_block(at));
    EXPECT_EQ(follower.occupied.hash(), robot.map.map().occupied.hash()) << i;
    EXPECT_EQ(changed.to, robot.map.map().revision());
  }
}

struct Look {
  Pose3 pose;
  Cloud cloud;
};

std::vector<Look> looks_of_a_day() {
  std::vector<Look> looks;
  for (int i = 0; i < 9; ++i) {
    const Pose2 pose = looking_from(i);
    const bool is_there = i < 2 || i == 6;
    looks.push_back({to_pose3(pose),
                     scan_of(is_there ? std::vector{kPerson, kPole} : std::vector{kPole}, pose)});
  }
  return looks;
}

CarvedMap made_of(const std::vector<Look>& looks) {
  CarvedMap map({.count_free = true});
  for (const Look& look : looks) map.add({look.pose, look.cloud});
  return map;
}

CarvedMap::Scans scans_of(const std::vector<Look>& looks, std::size_t& next) {
  return [&]() -> std::optional<CarvedMap::Scan> {
    if (next == looks.size()) return std::nullopt;
    const Look& look = looks[next++];
    return CarvedMap::Scan{look.pose, look.cloud};
  };
}

void recount(CarvedMap& map, const std::vector<Look>& touched, const std::vector<Look>& looks) {
  std::size_t first = 0, next = 0;
  const ChangedBlocks changed = map.recount(scans_of(touched, first), scans_of(looks, next));
  EXPECT_EQ(next, looks.size());
  EXPECT_EQ(changed.to, map.map().revision());
}

void expect_same(CarvedMap& a, CarvedMap b) {
  a.free_space().follow();
  b.free_space().follow();
  EXPECT_EQ(a.free_space().map().occupied.hash(), b.free_space().map().occupied.hash());
  EXPECT_EQ(a.free_space().map().passed.hash(), b.free_space().map().passed.hash());
  EXPECT_GT(b.free_space().map().passed.size(), 1000u);
  EXPECT_EQ(a.map().occupied.hash(), b.map().occupied.hash());
  EXPECT_EQ(a.map().passed.hash(), b.map().passed.hash());
  EXPECT_EQ(a.waiting().hash(), b.waiting().hash());
}

TEST(CarvedMap, AScanIsTakenOutAndPutBack) {
  const std::vector<Look> all = looks_of_a_day();
  for (const std::size_t out : {1u, 6u, 8u}) {
    std::vector<Look> others = all;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(out));
    CarvedMap map = made_of(all);
    recount(map, {all[out]}, others);
    expect_same(map, made_of(others));
    recount(map, {all[out]}, all);
    expect_same(map, made_of(all));
  }
}

TEST(CarvedMap, AScanIsMoved) {
  const std::vector<Look> before = looks_of_a_day();
  std::vector<Look> after = before;
  after[3].pose = to_pose3({2.0, 1.0, 0.5});
  CarvedMap map = made_of(before);
  recount(map, {before[3], after[3]}, after);
  expect_same(map, made_of(after));
}

TEST(CarvedMap, IsEmptyWhenCleared) {
  CarvedMap map = made_of(looks_of_a_day());
  map.clear();
  EXPECT_TRUE(map.map().empty());
  const std::vector<Look> looks = looks_of_a_day();
  for (const Look& look : looks) map.add({look.pose, look.cloud});
  expect_same(map, made_of(looks));
}

}  // namespace
}  // namespace voxlist
