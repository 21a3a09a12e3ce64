#include "voxlist/matching/search/window_search.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "tests/matching/synthetic_room.h"
#include "tests/system/instruction_sets.h"
#include "voxlist/matching/engines/matcher.h"

namespace voxlist::matching {
namespace {

MatchPoints telling_points(const std::vector<Eigen::Vector3f>& points) {
  const Cloud cloud{0, points, {}};
  return PreparedScan(cloud).points();
}

constexpr double kCell_m = 0.08;

// Whether a column of 0.08 m, a block high, holds a voxel or has a neighbour that does.
bool occupied(const VoxelMap& coarse, const Voxel& cell) {
  const auto holds = [&](std::int32_t x, std::int32_t y) {
    return coarse.contains({x, y, 2 * cell.z}) || coarse.contains({x, y, 2 * cell.z + 1});
  };
  return holds(cell.x, cell.y) || holds(cell.x - 1, cell.y) || holds(cell.x + 1, cell.y) ||
         holds(cell.x, cell.y - 1) || holds(cell.x, cell.y + 1);
}

int overlap_at(const VoxelMap& coarse, const MatchPoints& scan, const Pose2& pose) {
  const Pose2 turn{0.0, 0.0, pose.yaw_rad};
  const auto tx = static_cast<std::int32_t>(std::lround(pose.x_m / kCell_m)),
             ty = static_cast<std::int32_t>(std::lround(pose.y_m / kCell_m));
  int count = 0;
  for (const auto& p : scan.points) {
    const Voxel v = voxel_at(turn * p.cast<double>(), kCell_m);
    count += occupied(coarse, {v.x + tx, v.y + ty, floor_div(v.z, 2)});
  }
  return count;
}

VoxelMap coarse_map(const VoxelMap& map) {
  VoxelMap coarse(kCell_m);
  map.for_each_voxel([&](const Voxel& v) {
    coarse.insert({floor_div(v.x, 4), floor_div(v.y, 4), floor_div(v.z, 4)});
  });
  return coarse;
}

SearchResult search_in(const VoxelMap& map, const MatchPoints& scan, const PoseWindow& window,
                       const SearchConfig& config = {},
                       Instructions instructions = best_instructions()) {
  WindowMap ready(map);
  ready.hold(needed_ground(kCell_m, scan.radius_m, window));
  return search_window(ready, kCell_m, scan, window, config, instructions);
}

TEST(WindowSearch, BestOverlapEqualsBruteForceOverTheWindow) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const auto room = synthetic_room(6.0, 5.0, {2.5, 2.0, 0.7}, 1500, seed);
    const MatchPoints scan = some_of(telling_points(room.scan), 150);
    const PoseWindow window{{2.6, 1.9, 0.75}, 0.2, 0.3, 0.1};
    const SearchResult found = search_in(room.map, scan, window);
    ASSERT_FALSE(found.modes.empty()) << "seed " << seed;
    EXPECT_TRUE(found.certified);
    const VoxelMap coarse = coarse_map(room.map);
    EXPECT_EQ(overlap_at(coarse, scan, found.modes[0].pose), found.modes[0].overlap);
    const double step_rad = kCell_m / scan.radius_m;
    int best = 0, poses = 0;
    for (int a = -20; a <= 20; ++a) {
      if (std::abs(a * step_rad) > window.half_yaw_rad) continue;
      for (int x = -2; x <= 2; ++x) {
        for (int y = -3; y <= 3; ++y, ++poses) {
          const Pose2 pose{std::lround(2.6 / kCell_m) * kCell_m + x * kCell_m,
                           std::lround(1.9 / kCell_m) * kCell_m + y * kCell_m, 0.75 + a * step_rad};
          best = std::max(best, overlap_at(coarse, scan, pose));
        }
      }
    }
    EXPECT_GT(poses, 100);
    EXPECT_GE(found.modes[0].overlap, best) << "seed " << seed;
    EXPECT_EQ(found.bound, found.modes[0].overlap);
  }
}

void expect_equal(const SearchResult& a, const SearchResult& b) {
  ASSERT_GE(a.modes.size(), 1u);
  ASSERT_EQ(a.modes.size(), b.modes.size());
  for (std::size_t i = 0; i < a.modes.size(); ++i) {
    EXPECT_EQ(a.modes[i].pose, b.modes[i].pose);
    EXPECT_EQ(a.modes[i].overlap, b.modes[i].overlap);
  }
  EXPECT_EQ(a.poses_examined, b.poses_examined);
}

TEST(WindowSearch, GivesTheSameWithAnyInstructions) {
  const auto room = synthetic_room(6.0, 5.0, {2.5, 2.0, 0.7}, 3000, 8);
  // Numbers of points and tiles that do not fill the widest words.
  for (const std::size_t points : {1, 7, 8, 150, 403}) {
    const MatchPoints scan = some_of(telling_points(room.scan), points);
    for (const double half_m : {0.1, 0.4, 0.8, 1.7}) {
      const PoseWindow window{{2.4, 2.1, 0.5}, half_m, 0.7 * half_m, 0.4};
      const auto run = [&](Instructions instructions) {
        return search_in(room.map, scan, window, {.mode_ratio = 0.7}, instructions);
      };
      const SearchResult portable = run(Instructions::kPortable);
      for (const Instructions instructions : instruction_sets())
        expect_equal(portable, run(instructions));
    }
  }
}

TEST(WindowSearch, GivesTheSameForAnyNumberOfThreads) {
  const auto room = synthetic_room(6.0, 5.0, {2.5, 2.0, 0.7}, 3000, 4);
  const MatchPoints scan = some_of(telling_points(room.scan), 1000);
  const PoseWindow window{{2.0, 2.0, 0.0}, 1.2, 1.2, 3.2};
  const SearchConfig config{.mode_ratio = 0.6};
  const auto run = [&](std::size_t threads) {
    const tbb::global_control most(tbb::global_control::max_allowed_parallelism, threads);
    return search_in(room.map, scan, window, config);
  };
  expect_equal(run(1), run(4));
}

TEST(WindowSearch, FindsNothingInAnEmptyMapOrForAnEmptyScan) {
  const auto room = synthetic_room(6.0, 5.0, {2.5, 2.0, 0.7}, 1500, 5);
  const MatchPoints scan = telling_points(room.scan);
  const PoseWindow window{{2.5, 2.0, 0.7}, 0.2, 0.2, 0.1};
  EXPECT_TRUE(search_in(VoxelMap(), scan, window).modes.empty());
  EXPECT_TRUE(search_in(room.map, {}, window).modes.empty());
}

TEST(WindowMatcher, FindsAPoseThatIsOffByAMetreAndARightAngle) {
  const auto room = synthetic_room(6.0, 5.0, {2.5, 2.0, 0.7}, 5000, 6);
  const OccupancyMap map{room.map, VoxelMap(kPassedResolution_m)};
  const auto matcher = make_matcher(map, {});
  const Cloud cloud{0, room.scan, {}};
  const Match match =
      matcher->match(PreparedScan(cloud), PoseWindow{{3.2, 2.7, 2.2}, 1.2, 1.2, 3.2});
  ASSERT_FALSE(match.modes.empty());
  EXPECT_TRUE(match.certified);
  EXPECT_LT(distance_m(match.modes[0].pose, room.truth), 0.016);
  EXPECT_LT(turn_rad(match.modes[0].pose, room.truth), 0.003);
}

TEST(WindowMatcher, MovesOnToWhereItsMapWasNotReadyYet) {
  const auto room = synthetic_room(6.0, 5.0, {2.5, 2.0, 0.7}, 5000, 7);
  OccupancyMap map;
  room.map.for_each_voxel([&](const Voxel& v) {
    map.occupied.insert(v);
    map.occupied.insert({v.x + 2000, v.y, v.z});
  });
  const auto matcher = make_matcher(map, {});
  const Cloud cloud{0, room.scan, {}};
  for (const double x : {0.0, 40.0, 0.0}) {
    const Pose2 truth{room.truth.x_m + x, room.truth.y_m, room.truth.yaw_rad};
    const Match match = matcher->match(PreparedScan(cloud), PoseWindow{truth, 0.4, 0.4, 0.3});
    ASSERT_FALSE(match.modes.empty());
    EXPECT_LT(distance_m(match.modes[0].pose, truth), 0.016);
  }
}

}  // namespace
}  // namespace voxlist::matching
