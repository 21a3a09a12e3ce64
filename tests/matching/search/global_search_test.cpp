#include "voxlist/matching/search/global_search.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "tests/matching/search/lattice_world.h"
#include "tests/system/instruction_sets.h"

namespace voxlist::matching {
namespace {

constexpr double kCell_m = 0.08;
constexpr double kReach_m = 4.0;

bool same_bits(const SearchResult& a, const SearchResult& b) {
  if (a.modes.size() != b.modes.size()) return false;
  for (std::size_t i = 0; i < a.modes.size(); ++i)
    if (a.modes[i].pose != b.modes[i].pose || a.modes[i].overlap != b.modes[i].overlap)
      return false;
  return a.certified == b.certified && a.complete == b.complete && a.bound == b.bound &&
         a.lattice_poses == b.lattice_poses && a.poses_examined == b.poses_examined;
}

bool same_mode(const OverlapMode& a, const OverlapMode& b, const SearchConfig& config) {
  return distance_m(a.pose, b.pose) < config.mode_distance_m &&
         turn_rad(a.pose, b.pose) < config.mode_turn_rad;
}

TEST(GlobalSearch, IsCertifiedAndEqualsBruteForceOnAHundredWorlds) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const LatticeWorld world = lattice_world(seed);
    const auto scan = seed % 3 == 2 ? lattice_world(seed + 1000).scan : world.scan;
    const GlobalMap map(world.map, kCell_m, kReach_m);
    const AllOverlaps all(map, scan);
    const SearchResult result = global_search(map, scan, {});
    ASSERT_FALSE(result.modes.empty());
    ASSERT_TRUE(result.certified);
    ASSERT_TRUE(result.complete);
    ASSERT_EQ(result.modes[0].overlap, all.best());
    ASSERT_EQ(result.bound, all.best());
    for (const OverlapMode& mode : result.modes) ASSERT_EQ(all.at(mode.pose), mode.overlap);
    ASSERT_EQ(result.lattice_poses, double(all.angles()) * all.size_x() * all.size_y());
  }
}

TEST(GlobalSearch, BoundsAreNotBelowAnyPoseOfTheirNodes) {
  int tight = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    const LatticeWorld world = lattice_world(seed);
    const GlobalMap map(world.map, kCell_m, kReach_m);
    const AllOverlaps all(map, world.scan);
    TurnedPoints points(map.dilated(), world.scan);
    for (std::int32_t group = 0; group < points.groups(); ++group) {
      const NodeCounts counts =
          coarse_sweep(map.coarse(), points.coarse_cells(group, map.coarse()), best_instructions());
      for (std::int32_t x = 0; x < map.coarse().size_x(); ++x)
        for (std::int32_t y = 0; y < map.coarse().size_y(); ++y) {
          int best = 0;
          for (std::int32_t i = 0; i < 8 * 64; ++i)
            best = std::max(best, all.at(8 * group + i / 64, 8 * x + i % 8, 8 * y + i / 8 % 8));
          int bound = 0;
          const auto bit = static_cast<std::size_t>(y * map.coarse().row_bits() + x);
          for (std::size_t p = 0; p < kCountPlanes; ++p)
            bound |= static_cast<int>(counts.planes[p * counts.words + bit / 64] >> bit % 64 & 1)
                     << p;
          ASSERT_GE(bound, best) << "seed " << seed << ", node " << group << ' ' << x << ' ' << y;
          tight += bound < 2 * best;
        }
    }
  }
  EXPECT_GT(tight, 0);
}

// The poses with at least `least` that no pose within a mode's distance betters.
std::vector<OverlapMode> local_bests(const AllOverlaps& all, double least,
                                     const SearchConfig& config) {
  std::vector<OverlapMode> strong;
  all.for_each([&](std::int32_t angle, std::int32_t x, std::int32_t y, int overlap) {
    if (overlap >= least) strong.push_back({all.pose(angle, x, y), overlap});
  });
  std::vector<OverlapMode> bests;
  std::copy_if(strong.begin(), strong.end(), std::back_inserter(bests), [&](const auto& mode) {
    return std::none_of(strong.begin(), strong.end(), [&](const auto& other) {
      return other.overlap > mode.overlap && same_mode(mode, other, config);
    });
  });
  return bests;
}

TEST(GlobalSearch, ModesAreDistinctAndLeaveNoLocalBestOut) {
  std::size_t modes = 0;
  for (const std::size_t most : {3u, 1000u})
    for (unsigned seed = 0; seed < 20; ++seed) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", at most " << most);
      const SearchConfig config{.mode_ratio = 0.7, .max_modes = most};
      const LatticeWorld world = lattice_world(seed);
      const auto scan = seed % 2 == 1 ? lattice_world(seed + 1000).scan : world.scan;
      const GlobalMap map(world.map, 0.04, kReach_m);
      const AllOverlaps all(map, scan);
      const SearchResult result = global_search(map, scan, config);
      ASSERT_TRUE(result.complete);
      ASSERT_LE(result.modes.size(), most);
      for (std::size_t i = 0; i < result.modes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
          EXPECT_FALSE(same_mode(result.modes[i], result.modes[j], config)) << i << ' ' << j;
          EXPECT_LE(result.modes[i].overlap, result.modes[j].overlap) << i << ' ' << j;
        }
      const double least = config.mode_ratio * all.best();
      EXPECT_GE(result.modes.back().overlap, least);
      for (const OverlapMode& best : local_bests(all, least, config)) {
        const bool listed =
            std::any_of(result.modes.begin(), result.modes.end(), [&](const OverlapMode& mode) {
              return mode.overlap >= best.overlap && same_mode(mode, best, config);
            });
        const bool no_room =
            result.modes.size() == most && result.modes.back().overlap >= best.overlap;
        EXPECT_TRUE(listed || no_room) << best.overlap << " of " << all.best();
      }
      modes += result.modes.size();
    }
  EXPECT_GT(modes, 60u);
}

TEST(GlobalSearch, SaysWhenItsBudgetEndedIt) {
  int ended = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const LatticeWorld world = lattice_world(seed);
    const GlobalMap map(world.map, kCell_m, kReach_m);
    const int best = AllOverlaps(map, world.scan).best();
    for (const std::int64_t nodes : {0, 1, 5, 20}) {
      const SearchResult result = global_search(map, world.scan, {.max_nodes = nodes});
      ASSERT_GE(result.bound, best);
      ASSERT_EQ(result.certified, result.bound == result.modes[0].overlap);
      ASSERT_TRUE(!result.certified || result.modes[0].overlap == best);
      ASSERT_TRUE(result.certified || !result.complete);
      ended += !result.certified;
    }
  }
  EXPECT_GT(ended, 20);
}

TEST(GlobalSearch, GivesTheSameBitsForAllThreadsAndInstructions) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const LatticeWorld world = lattice_world(seed);
    const GlobalMap map(world.map, 0.04, kReach_m);
    const SearchResult one = [&] {
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 1);
      return global_search(map, world.scan, {}, Instructions::kPortable);
    }();
    for (const std::size_t threads : {1u, 2u, 4u}) {
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
      for (const Instructions instructions : instruction_sets())
        EXPECT_TRUE(same_bits(global_search(map, world.scan, {}, instructions), one))
            << "seed " << seed << ", " << threads << " threads, instructions "
            << static_cast<int>(instructions);
    }
  }
}

TEST(GlobalSearch, FindsNothingInAnEmptyMapOrForAnEmptyScan) {
  const LatticeWorld world = lattice_world(1);
  const GlobalMap map(world.map, kCell_m, kReach_m), empty(VoxelMap(), kCell_m, kReach_m);
  std::vector<Eigen::Vector3f> above{{1.0F, 0.0F, 9.0F}, {1.0F, 1.0F, -9.0F}};
  for (const SearchResult& result : {global_search(map, {}, {}), global_search(map, above, {}),
                                     global_search(empty, world.scan, {})}) {
    EXPECT_TRUE(result.modes.empty());
    EXPECT_FALSE(result.certified);
    EXPECT_EQ(result.bound, 0);
  }
}

TEST(GlobalSearch, PointsOutsideTheLayersChangeNothing) {
  const LatticeWorld world = lattice_world(2);
  const GlobalMap map(world.map, kCell_m, kReach_m);
  auto more = world.scan;
  for (float z : {-3.0F, 3.0F, 100.0F}) more.insert(more.begin() + 5, {3.9F, 0.1F, z});
  EXPECT_TRUE(same_bits(global_search(map, more, {}), global_search(map, world.scan, {})));
}

TEST(GlobalSearch, FindsAScanThatLooksInFromTheMapsEdge) {
  // A pose from which most points, turned by some other angle, would lie far outside the map.
  const LatticeWorld world = lattice_world(3);
  const Voxel corner = DilatedMap(world.map, 0.04, kReach_m).lowest();
  const Pose2 truth{corner.x * 0.04, corner.y * 0.04, 2.0};
  std::vector<Eigen::Vector3f> scan;
  std::int64_t count = 0;
  world.map.for_each_voxel([&](const Voxel& v) {
    if (++count % 40 == 0)
      scan.push_back((truth.inverse() * center(v, kFinestResolution_m)).cast<float>());
  });
  const SearchResult result = global_search(GlobalMap(world.map, 0.04, kReach_m), scan, {});
  ASSERT_TRUE(result.certified);
  EXPECT_LT(distance_m(result.modes[0].pose, truth), 0.06);
  EXPECT_LT(turn_rad(result.modes[0].pose, truth), 0.03);
  EXPECT_GT(result.modes[0].overlap, 0.95 * static_cast<double>(scan.size()));
}

TEST(GlobalSearch, RefusesWhatItCannotCount) {
  const GlobalMap map(lattice_world(1).map, kCell_m, kReach_m);
  const std::vector<Eigen::Vector3f> many(kMostSearchPoints + 1, {1.0F, 0.0F, 0.1F});
  EXPECT_THROW(global_search(map, many, {}), std::invalid_argument);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Eigen::Vector3f& p : {Eigen::Vector3f(4.1F, 0.0F, 0.1F), Eigen::Vector3f(nan, 0, 0),
                                   Eigen::Vector3f(1, 0, nan), Eigen::Vector3f(1, 0, 1e30F)})
    EXPECT_THROW(global_search(map, std::span(&p, 1), {}), std::invalid_argument);
}

TEST(GlobalMap, DoublesItsCellForScansThatReachFar) {
  const VoxelMap map = lattice_world(1).map;
  EXPECT_DOUBLE_EQ(GlobalMap(map, 0.04, 32.0).dilated().cell_m(), 0.04);
  EXPECT_DOUBLE_EQ(GlobalMap(map, 0.04, 33.0).dilated().cell_m(), 0.08);
  EXPECT_DOUBLE_EQ(GlobalMap(map, 0.04, 100.0).dilated().cell_m(), 0.16);
}

// A room of 4 x 4 x 1 m with floor and ceiling, and `n` points on one of its walls.
class ChoosePoints : public testing::Test {
 protected:
  ChoosePoints() {
    for (std::int32_t x = 0; x <= 200; ++x)
      for (std::int32_t y = 0; y <= 200; ++y)
        for (std::int32_t z = 0; z <= 50; ++z)
          if (x % 200 == 0 || y % 200 == 0 || z % 50 == 0) voxels_.insert({x, y, z});
  }
  static std::vector<Eigen::Vector3f> wall(std::size_t n) {
    std::vector<Eigen::Vector3f> points;
    for (std::size_t i = 0; i < n; ++i)
      points.emplace_back(2.0F, -2.0F + 4.0F * float(i) / float(n), 0.5F);
    return points;
  }
  static std::vector<Eigen::Vector3f> floor_and_ceiling() {
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < 500; ++i) points.emplace_back(0.002F * float(i), 0.0F, i % 2 ? 0.0F : 1.0F);
    return points;
  }

  // What a search of the room would count of a scan.
  std::vector<Eigen::Vector3f> chosen(const std::vector<Eigen::Vector3f>& points,
                                      std::size_t most) const {
    const Cloud cloud{0, points, {}};
    return GlobalMap(voxels_, 0.04, 4.0).choose_points(PreparedScan(cloud), most);
  }

  VoxelMap voxels_;
};

TEST_F(ChoosePoints, LeavesFloorAndCeilingOut) {
  auto scan = floor_and_ceiling();
  const auto telling = wall(100);
  scan.insert(scan.begin() + 200, telling.begin(), telling.end());
  const auto points = chosen(scan, 1000);
  EXPECT_EQ(points.size(), 99u);  // the wall's farthest point stands alone
  for (const auto& p : points) EXPECT_EQ(p.z(), 0.5F);
}

TEST_F(ChoosePoints, KeepsFloorAndCeilingWhenNothingElseIsThere) {
  auto scan = floor_and_ceiling();
  scan.push_back(wall(1)[0]);  // which stands alone
  EXPECT_EQ(chosen(scan, 1000).size(), scan.size() - 1);
}

TEST_F(ChoosePoints, KeepsEachOfFewPointsOnce) {
  for (const std::size_t n : {1u, 2u, 50u, 300u}) {
    auto points = chosen(wall(n), n);
    std::sort(points.begin(), points.end(),
              [](const auto& a, const auto& b) { return a.y() < b.y(); });
    EXPECT_EQ(points, wall(n));
  }
}

TEST_F(ChoosePoints, WhoStandsNearIsNotCountedByTheirPoints) {
  std::vector<Eigen::Vector3f> scan;
  for (int y = 0; y < 200; ++y)
    for (int z = 5; z < 45; ++z)
      scan.emplace_back(2.0F, -2.0F + 0.02F * float(y), 0.02F * float(z));
  for (int i = 0; i < 5000; ++i) scan.emplace_back(0.3F, 0.2F + 0.00004F * float(i), 0.5F);
  const auto points = chosen(scan, 1000);
  const auto near =
      std::count_if(points.begin(), points.end(), [](const auto& p) { return p.x() < 1.0F; });
  EXPECT_GE(points.size(), 300u);
  EXPECT_LT(double(near), 0.1 * double(points.size()));
}

TEST_F(ChoosePoints, SpreadsAnyFirstPartOfThemEvenly) {
  const auto points = chosen(wall(7000), 1000);
  ASSERT_EQ(points.size(), 1000u);
  for (const std::size_t part : {10u, 100u, 300u, 1000u}) {
    std::vector<float> y;
    for (std::size_t i = 0; i < part; ++i) y.push_back(points[i].y());
    std::sort(y.begin(), y.end());
    for (std::size_t i = 1; i < part; ++i) {
      EXPECT_GT(y[i] - y[i - 1], 0.3F * 4.0F / float(part)) << part;
      EXPECT_LT(y[i] - y[i - 1], 3.0F * 4.0F / float(part)) << part;
    }
  }
}

TEST_F(ChoosePoints, DropsWhatNoSearchCanUse) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  auto scan = wall(100);
  for (const float odd : {nan, 1e30F, -std::numeric_limits<float>::infinity()})
    for (int axis = 0; axis < 3; ++axis) {
      scan.emplace_back(1.0F, 0.0F, 0.5F);
      scan.back()[axis] = odd;
    }
  scan.emplace_back(4.1F, 0.0F, 0.5F);
  EXPECT_EQ(chosen(scan, 1000).size(), 100u);
  EXPECT_EQ(chosen(wall(20'000), 20'000).size(), kMostSearchPoints);
}

}  // namespace
}  // namespace voxlist::matching
