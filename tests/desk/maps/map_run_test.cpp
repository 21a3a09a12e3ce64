// Drives that begin badly, have gaps, or come back: which pieces they are mapped in, and what the
// map is in the end.
#include "services/voxlist/maps/map_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/temporary_folder.h"
#include "voxlist/simulation/building/floor_plan.h"
#include "voxlist/simulation/random.h"
#include "voxlist/simulation/world/world.h"

namespace voxlist::desk {
namespace {

using simulation::Building;

constexpr double kLaser_m = 1.0, kRange_m = 12.0, kNoise_m = 0.01;
// Long enough for a robot to leave a room.
constexpr std::int64_t kStep_us = 6'000'000;

// What a laser with 48 rings sees from a pose, in base.
Cloud scan_of(const simulation::World& world, const Pose2& pose, std::uint64_t seed,
              double farthest_m = kRange_m) {
  simulation::Random random(seed);
  Cloud cloud;
  const Eigen::Vector3d laser(pose.x_m, pose.y_m, kLaser_m);
  for (int i = 0; i < 48 * 180; ++i) {
    const double up = (-35.0 + 70.0 * (i / 180) / 47.0) * std::numbers::pi / 180.0,
                 turn = 2.0 * (i % 180) * std::numbers::pi / 180.0;
    const Eigen::Vector3d way(std::cos(up) * std::cos(turn), std::cos(up) * std::sin(turn),
                              std::sin(up));
    const auto range_m = world.range(laser, to_pose3(pose).linear() * way, 0.0);
    if (!range_m || *range_m > farthest_m) continue;
    const Eigen::Vector3d end = (*range_m + kNoise_m * random.normal()) * way;
    cloud.points.push_back((Eigen::Vector3d(0.0, 0.0, kLaser_m) + end).cast<float>());
    cloud.origins.emplace_back(0.0F, 0.0F, static_cast<float>(kLaser_m));
  }
  return cloud;
}

class MapRunTest : public testing::Test {
 protected:
  static Building building(int seed) {
    simulation::BuildingConfig config;
    config.seed = seed;
    return simulation::make_building(config);
  }

  // The middle of a room, and so far towards its door.
  Pose2 in_room(std::size_t room, double share = 0.0) const {
    const simulation::Room& r = world_.building().rooms[room];
    const Eigen::Vector2d at = (1.0 - share) * r.centre() + share * r.door;
    return {at.x(), at.y(), 0.3};
  }

  // Straight from one pose to another, half a metre a scan.
  void drive(MapRun& run, const Pose2& from, const Pose2& to) {
    const int steps = static_cast<int>(std::ceil(distance_m(from, to) / 0.5));
    for (int i = 1; i <= steps; ++i)
      see(run, from * part_of(from.inverse() * to, static_cast<double>(i) / steps));
  }

  // The robot drives from the middle of one room to the middle of another.
  void drive(MapRun& run, std::size_t from, std::size_t to) {
    const auto at = [&](std::size_t room) { return in_room(room, 1.0); };
    const auto before = [&](std::size_t room) { return Pose2{at(room).x_m, 0.0, 0.3}; };
    const Pose2 way[] = {in_room(from), at(from), before(from), before(to), at(to), in_room(to)};
    for (std::size_t i = 0; i + 1 < std::size(way); ++i) drive(run, way[i], way[i + 1]);
  }

  void see(MapRun& run, const Pose2& pose) { see(run, world_, pose); }

  void see(MapRun& run, const simulation::World& world, const Pose2& pose) {
    show(run, scan_of(world, pose, static_cast<std::uint64_t>(number_) + 1), pose);
  }

  // Points anywhere.
  void see_nonsense(MapRun& run, const Pose2& pose = {}) {
    simulation::Random random(static_cast<std::uint64_t>(number_) + 77);
    Cloud cloud;
    for (int i = 0; i < 3000; ++i)
      cloud.points.push_back(Eigen::Vector3d(random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0),
                                             random.uniform(0.0, 2.0))
                                 .cast<float>());
    show(run, cloud, pose);
  }

  // Every pose of the run's trajectory is where the scan was taken, in the frame of its first one.
  void expect_true_poses(const MapRun& run) const {
    const auto trajectory = run.trajectory();
    ASSERT_FALSE(trajectory.empty());
    const auto truth = [&](const StampedPose3& pose) {
      return truth_[static_cast<std::size_t>(pose.utime_us / step_us_)];
    };
    const Pose2 T_true_map =
        truth(trajectory.front()) * to_pose2(trajectory.front().pose).inverse();
    for (const StampedPose3& pose : trajectory) {
      const Pose2 found = T_true_map * to_pose2(pose.pose);
      EXPECT_LT(distance_m(found, truth(pose)), 0.1) << pose.utime_us;
      EXPECT_LT(turn_rad(found, truth(pose)), 0.01) << pose.utime_us;
    }
  }

  const simulation::World world_{building(1)};
  const test::TemporaryFolder folder_;
  mapping::KeyframeSpool spool_{folder_.path()};

  // Four bare walls, 10 m by 6 m, and what stands there.
  static Building bare_room(const std::vector<simulation::Box>& more = {}) {
    using simulation::block;
    std::vector<simulation::Box> boxes{
        block({-5.2, -3.2, -0.2}, {5.2, 3.2, 0.0}), block({-5.2, 3.0, 0.0}, {5.2, 3.2, 2.6}),
        block({-5.2, -3.2, 0.0}, {5.2, -3.0, 2.6}), block({-5.2, -3.0, 0.0}, {-5.0, 3.0, 2.6}),
        block({5.0, -3.0, 0.0}, {5.2, 3.0, 2.6})};
    boxes.insert(boxes.end(), more.begin(), more.end());
    return {simulation::BoxTree(std::move(boxes)), {}, {}};
  }

  void show(MapRun& run, Cloud cloud, const Pose2& pose) {
    cloud.utime_us = number_ * step_us_;
    truth_.push_back(pose);
    const auto T_odom_base = odometry_ ? std::optional(pose) : std::nullopt;
    run.localise({number_++, std::move(cloud), T_odom_base, std::nullopt});
  }

  std::int64_t step_us_ = kStep_us;
  bool odometry_ = false;  // exact

 private:
  std::int64_t number_ = 0;
  std::vector<Pose2> truth_;
};

TEST_F(MapRunTest, BeginsAtTheNextScanWhereTheFirstWasBad) {
  MapRun run({}, {}, spool_);
  see_nonsense(run);
  for (const double share : {0.0, 0.2, 0.4}) see(run, in_room(0, share));
  run.finish();
  EXPECT_EQ(run.figures().placed, 3);
  EXPECT_EQ(run.figures().lost, 1);
  EXPECT_EQ(run.figures().pieces, 0);
  EXPECT_EQ(run.trajectory().front().utime_us, kStep_us);
  expect_true_poses(run);
}

TEST_F(MapRunTest, GoesOnInTheOldPieceAfterABadScan) {
  MapRun run({}, {}, spool_);
  for (const double share : {0.0, 0.2}) see(run, in_room(0, share));
  for (int i = 0; i < 2; ++i) see_nonsense(run);
  for (const double share : {0.4, 0.5}) see(run, in_room(0, share));
  run.finish();
  EXPECT_EQ(run.figures().placed, 4);
  EXPECT_EQ(run.figures().pieces, 0);
  ASSERT_TRUE(run.figures().first_lost);
  EXPECT_EQ(run.figures().first_lost->number, 2);
  EXPECT_EQ(run.figures().first_lost->seconds, 2e-6 * static_cast<double>(kStep_us));
  expect_true_poses(run);
}

// A robot that cannot have gone far sees what the map has there, sooner or later.
TEST_F(MapRunTest, BeginsNoPieceNearTheLastPlace) {
  matching::LocaliserConfig slow;
  slow.max_speed_mps = 0.5;
  MapRun run(slow, {}, spool_);
  for (const double share : {0.0, 0.2}) see(run, in_room(0, share));
  for (int i = 0; i < 2; ++i) see(run, in_room(1, 0.2 * i));
  EXPECT_EQ(run.figures().placed, 2);
  EXPECT_EQ(run.figures().pieces, 0);
}

// However long it took: by odometry the robot has hardly moved.
TEST_F(MapRunTest, BeginsNoPieceWhereOdometryHasTheRobotNear) {
  odometry_ = true;
  MapRun run({}, {}, spool_);
  for (const double share : {0.0, 0.2}) see(run, in_room(0, share));
  see_nonsense(run, in_room(0, 0.3));
  EXPECT_EQ(run.figures().placed, 2);
  EXPECT_EQ(run.figures().pieces, 0);
}

// Between two walls that look the same everywhere the robot is followed, if vaguely. By then it may
// have turned round, so something must tell the room's ends apart.
TEST_F(MapRunTest, BeginsNoPieceWhereTheRobotIsFollowed) {
  const simulation::World room(bare_room({simulation::block({3.8, 1.8, 0.0}, {5.0, 3.0, 1.8})}));
  matching::LocaliserConfig fast;
  fast.max_speed_mps = 4.0;  // in three seconds it may have left what it saw
  MapRun run(fast, {}, spool_);
  step_us_ = 1'000'000;
  const auto see_from = [&](int i, double range_m) {
    const Pose2 pose{-2.0 + 0.2 * i, 0.0, 0.0};
    show(run, scan_of(room, pose, static_cast<std::uint64_t>(i), range_m), pose);
  };
  for (int i = 0; i < 6; ++i) see_from(i, kRange_m);
  for (int i = 6; i < 9; ++i) see_from(i, 3.5);
  EXPECT_EQ(run.figures().pieces, 0);
  EXPECT_EQ(run.figures().ambiguous, 3);
  for (int i = 9; i < 11; ++i) see_from(i, kRange_m);
  EXPECT_EQ(run.figures().placed, 8);
  expect_true_poses(run);
}

TEST_F(MapRunTest, LeavesAPieceThatNothingJoinsOutOfTheMap) {
  MapRun run({}, {}, spool_);
  for (const double share : {0.0, 0.2, 0.4}) see(run, in_room(0, share));
  const std::uint64_t hash = run.builder().map().occupied.hash();
  const simulation::World elsewhere(building(9));
  for (const double x : {2.0, 2.2}) see(run, elsewhere, {x, 0.0, 0.0});
  run.finish();
  EXPECT_EQ(run.figures().placed, 3);
  EXPECT_EQ(run.figures().pieces, 1);
  EXPECT_EQ(run.figures().in_pieces, 2);
  EXPECT_EQ(run.figures().lost + run.figures().ambiguous, 0);
  EXPECT_EQ(run.trajectory().size(), 3u);
  EXPECT_EQ(run.builder().map().occupied.hash(), hash);
}

TEST_F(MapRunTest, TakesTheLargestPieceForTheMap) {
  const simulation::World elsewhere(building(9));
  MapRun run({}, {}, spool_);
  for (const double x : {2.0, 2.2}) see(run, elsewhere, {x, 0.0, 0.0});
  for (const double share : {0.0, 0.2, 0.4}) see(run, in_room(0, share));
  run.finish();
  EXPECT_EQ(run.figures().in_pieces, 2);
  EXPECT_EQ(run.trajectory().front().utime_us, 2 * kStep_us);
  expect_true_poses(run);
}

// The robot goes to another room without a scan on its way, and comes back with scans.
TEST_F(MapRunTest, MakesOneOfTwoPiecesWhereAScanFitsBoth) {
  MapRun run({}, {}, spool_);
  for (const double share : {0.0, 0.2, 0.4}) see(run, in_room(0, share));
  for (const double share : {0.2, 0.1}) see(run, in_room(5, share));
  EXPECT_EQ(run.figures().pieces, 1);
  EXPECT_EQ(run.figures().in_pieces, 2);
  drive(run, 5, 0);
  EXPECT_EQ(run.figures().pieces, 0);
  run.finish();
  EXPECT_GT(run.figures().placed, 25);
  EXPECT_EQ(run.figures().lost + run.figures().ambiguous, 0);
  EXPECT_EQ(run.keyframes().size(), run.builder().poses().size());
  expect_true_poses(run);
}

// The robot was in a room, then long elsewhere, and in the room again: what it saw of the room is
// one piece, though it is not the map.
TEST_F(MapRunTest, JoinsPiecesAtTheEndThatAreNotTheMap) {
  const simulation::World elsewhere(building(9));
  MapRun run({}, {}, spool_);
  for (const double share : {0.2, 0.1}) see(run, in_room(0, share));
  for (int i = 0; i < 6; ++i) see(run, elsewhere, {2.0 + 0.2 * i, 0.0, 0.0});
  for (const double share : {0.0, -0.1}) see(run, in_room(0, share));
  EXPECT_EQ(run.figures().pieces, 2);
  run.finish();
  EXPECT_EQ(run.figures().placed, 6);
  EXPECT_EQ(run.figures().pieces, 1);
  EXPECT_EQ(run.figures().in_pieces, 4);
  expect_true_poses(run);
}

TEST_F(MapRunTest, PlacesAScanAtTheEndWhereTheMapHasGrown) {
  MapRun run({}, {}, spool_);
  see(run, in_room(5));
  for (const double share : {0.2, 0.1}) see(run, in_room(0, share));
  drive(run, 0, 5);
  EXPECT_EQ(run.trajectory().front().utime_us, kStep_us);
  const std::int64_t placed = run.figures().placed;
  run.finish();
  EXPECT_EQ(run.figures().placed, placed + 1);
  EXPECT_EQ(run.trajectory().front().utime_us, 0);
  expect_true_poses(run);
}

// Both ends of the room look the same, so that a search of the whole map cannot place it.
TEST_F(MapRunTest, PlacesAScanAtTheEndWhereOdometryHasIt) {
  const simulation::World room(bare_room());
  odometry_ = true;
  MapRun run({}, {}, spool_);
  const auto see_from = [&](double x_m) {
    const Pose2 pose{x_m, 0.0, 0.0};
    show(run, scan_of(room, pose, static_cast<std::uint64_t>(100.0 + 2.0 * x_m), 4.0), pose);
  };
  for (const double x_m : {-3.5, -3.0, 3.0}) see_from(x_m);
  EXPECT_EQ(run.figures().placed, 2);
  for (double x_m = -2.5; x_m < 3.0; x_m += 0.5) see_from(x_m);
  EXPECT_EQ(run.figures().placed, 13);
  run.finish();
  EXPECT_EQ(run.figures().placed, 14);
  expect_true_poses(run);
}

TEST_F(MapRunTest, KeepsWhatJoinsAMapThatWasThereAndNothingElse) {
  mapping::MapBuilder before;
  for (const double share : {0.0, 0.4})
    before.add({to_pose3(in_room(0, share)), scan_of(world_, in_room(0, share), 99)});
  std::vector<mapping::Keyframe> kept;
  MapRun run({}, {}, spool_, std::move(before),
             [&](const mapping::Keyframe& keyframe, const std::optional<Pose2>&) {
               kept.push_back(keyframe);
             });
  for (const double share : {0.2, 0.1}) see(run, in_room(5, share));
  EXPECT_TRUE(kept.empty());
  EXPECT_EQ(run.figures().placed, 0);
  drive(run, 5, 0);
  run.finish();
  EXPECT_GT(run.figures().placed, 25);
  EXPECT_EQ(kept.size() + 2, run.builder().poses().size());
  expect_true_poses(run);
}

}  // namespace
}  // namespace voxlist::desk
