#include "matching/search.h"

#include <gtest/gtest.h>

#include <random>

namespace voxlist {
namespace {

// A map of random short walls, and a scan of it taken from `truth`.
struct World {
  VoxelMap map;
  MatchPoints scan;
};

World random_world(unsigned seed, const Pose2& truth) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-3.0, 3.0), heading(-3.1, 3.1);
  World world;
  const Pose2 T_base_map = truth.inverse();
  for (int wall = 0; wall < 12; ++wall) {
    const Pose2 T{place(random), place(random), heading(random)};
    for (double s = 0.0; s < 1.0; s += 0.01) {
      for (double z = 0.0; z < 0.5; z += 0.02) {
        const Eigen::Vector3d p = T * Eigen::Vector3d(s, 0.0, z);
        world.map.insert(voxel_at(p, 0.02));
        if (random() % 40 == 0) world.scan.points.push_back((T_base_map * p).cast<float>());
      }
    }
  }
  for (const auto& p : world.scan.points) {
    world.scan.radius_m = std::max(world.scan.radius_m, double(std::hypot(p.x(), p.y())));
  }
  return world;
}

int overlap_at(const SearchMap& map, const MatchPoints& scan, const Pose2& pose) {
  int count = 0;
  const double e = map.pyramid().resolution_m();
  const Pose2 turn{0.0, 0.0, pose.yaw_rad};
  const auto tx = static_cast<int>(std::lround(pose.x_m / e)),
             ty = static_cast<int>(std::lround(pose.y_m / e));
  for (const auto& p : scan.points) {
    const Voxel v = voxel_at(turn * p.cast<double>(), e);
    count += map.pyramid().level(0).test({v.x + tx, v.y + ty, v.z});
  }
  return count;
}

TEST(Sweep, CountsLikeAPointByPointLookUp) {
  const World world = random_world(1, {});
  const SearchMap map(world.map);
  const int stride = map.top().stride(), top = map.pyramid().top();
  std::vector<Voxel> cells;
  for (const auto& p : world.scan.points)
    cells.push_back(voxel_at(p, map.pyramid().resolution_m()));
  const SweepWindow window{-70, -50, 130 / stride + 70, 9};
  std::vector<std::uint16_t> counts(static_cast<std::size_t>(window.nx * window.ny));
  sweep_overlaps(map.top(), cells, window, counts);
  int total = 0;
  for (int j = 0; j < window.ny; ++j) {
    for (int i = 0; i < window.nx; ++i) {
      int expected = 0;
      for (const Voxel& c : cells) {
        expected += map.pyramid().level(top).test(
            {c.x + window.x0 + i * stride, c.y + window.y0 + j * stride, c.z});
      }
      ASSERT_EQ(counts[static_cast<std::size_t>(j * window.nx + i)], expected) << i << ' ' << j;
      total += expected;
    }
  }
  EXPECT_GT(total, 0);
}

TEST(Search, FindsThePoseThatTheScanWasTakenFrom) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Pose2 truth{0.3 * seed - 1.0, 0.7 - 0.1 * seed, 0.6 * seed - 3.0};
    const World world = random_world(seed, truth);
    const SearchMap map(world.map);
    const auto result = search(map, world.scan, whole_map(map), {});
    ASSERT_FALSE(result.modes.empty());
    EXPECT_TRUE(result.complete);
    EXPECT_TRUE(result.certified);
    EXPECT_LT(distance_m(result.modes[0].pose, truth), 0.12) << "seed " << seed;
    EXPECT_LT(turn_rad(result.modes[0].pose, truth), 0.05) << "seed " << seed;
  }
}

TEST(Search, BestOverlapEqualsBruteForceOverTheWindow) {
  for (unsigned seed = 100; seed < 110; ++seed) {
    const World world = random_world(seed, {0.5, 0.2, 1.0});
    const SearchMap map(world.map);
    const PoseWindow window{{0.4, 0.3, 0.9}, 0.5, 0.5, 0.2};
    const auto result = search(map, world.scan, window, {});
    ASSERT_TRUE(result.certified);
    EXPECT_EQ(overlap_at(map, world.scan, result.modes[0].pose), result.modes[0].overlap);
    // The lattice of the window, by the header's words: whole top nodes around its centre.
    const double e = map.pyramid().resolution_m(), step = e / world.scan.radius_m;
    const int node = 1 << map.pyramid().top();
    const auto whole = [&](double half, double unit) {
      const int count = static_cast<int>(std::ceil(2 * half / unit)) + 1;
      return (count + node - 1) / node * node;
    };
    const int n = whole(0.5, e), angles = whole(0.2, step);
    const int x0 = static_cast<int>(std::lround(0.4 / e)) - n / 2,
              y0 = static_cast<int>(std::lround(0.3 / e)) - n / 2;
    int best = 0;
    for (int a = 0; a < angles; ++a)
      for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y) {
          best = std::max(best, overlap_at(map, world.scan,
                                           {(x0 + x) * e, (y0 + y) * e,
                                            0.9 + step * (a - (angles - 1) / 2.0)}));
        }
    EXPECT_EQ(result.modes[0].overlap, best) << "seed " << seed;
  }
}

TEST(Search, ReportsBothOfTwoEqualPlaces) {
  const World world = random_world(7, {});
  VoxelMap twice;
  world.map.for_each_voxel([&](const Voxel& v) {
    twice.insert(v);
    twice.insert({v.x + 600, v.y, v.z});
  });
  const SearchMap map(twice);
  const auto result = search(map, world.scan, whole_map(map), {});
  ASSERT_GE(result.modes.size(), 2u);
  EXPECT_NEAR(distance_m(result.modes[0].pose, result.modes[1].pose), 12.0, 0.2);
  EXPECT_EQ(result.modes[0].overlap, result.modes[1].overlap);
}

TEST(Search, SaysWhenItsBudgetEndedIt) {
  const World world = random_world(8, {});
  const SearchMap map(world.map);
  const auto result = search(map, world.scan, whole_map(map), {.max_nodes = 1});
  EXPECT_FALSE(result.certified);
  EXPECT_FALSE(result.complete);
  EXPECT_TRUE(result.modes.empty());
  EXPECT_GT(result.bound, 0);
}

TEST(Search, FindsNothingInAnEmptyMapOrForAnEmptyScan) {
  const World world = random_world(9, {});
  const SearchMap empty{VoxelMap()}, map(world.map);
  EXPECT_TRUE(search(empty, world.scan, whole_map(empty), {}).modes.empty());
  EXPECT_TRUE(search(map, {}, whole_map(map), {}).modes.empty());
}

}  // namespace
}  // namespace voxlist
