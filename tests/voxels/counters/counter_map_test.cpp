#include "voxlist/voxels/counters/counter_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "tests/system/instruction_sets.h"
#include "tests/voxels/counters/exact_walk.h"

namespace voxlist {
namespace {

constexpr std::uint32_t kSeed = 20'260'516;
constexpr double kResolution_m = 0.1;

struct Scan {
  Pose3 pose;
  Cloud cloud;
};

// Scans with an origin of their own for each ray.
std::vector<Scan> scans(int count, int rays, double range_m) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  std::vector<Scan> all;
  for (int i = 0; i < count; ++i) {
    Scan scan{to_pose3({unit(random), unit(random), 3.0 * unit(random)}), {}};
    for (int k = 0; k < rays; ++k) {
      const Eigen::Vector3f origin(0.2F * unit(random), 0.2F * unit(random), 0.5F);
      const Eigen::Vector3f way(unit(random), unit(random), unit(random));
      scan.cloud.origins.push_back(origin);
      scan.cloud.points.push_back(origin + static_cast<float>(range_m) * way);
    }
    all.push_back(std::move(scan));
  }
  return all;
}

RayRules rules() {
  RayRules rules;
  rules.resolution_m = kResolution_m;
  return rules;
}

CounterMap map_of(const std::vector<Scan>& scans, const RayRules& rules,
                  Instructions instructions = best_instructions()) {
  RayScratch scratch(rules, instructions);
  CounterMap map(rules.resolution_m);
  for (const Scan& scan : scans) {
    EXPECT_TRUE(scratch.mark(scan.pose, scan.cloud));
    map.add(scratch);
  }
  return map;
}

// The same cell by cell: an exact walk, and one count for each known cell.
class SlowMap {
 public:
  void add(const Scan& scan) {
    std::set<Voxel> passed, hit;
    for (std::size_t i = 0; i < scan.cloud.points.size(); ++i) {
      FixedRay ray;
      put(scan.pose * scan.cloud.origin(i).cast<double>(), ray.from);
      put(scan.pose * scan.cloud.points[i].cast<double>(), ray.to);
      passed.merge(exact_walk(ray));
      hit.insert(
          {ray.to[0] >> kFractionBits, ray.to[1] >> kFractionBits, ray.to[2] >> kFractionBits});
    }
    for (const Voxel& cell : passed) {
      int& count = counts_[{cell.x - kReach, cell.y - kReach, cell.z - kReach}];
      count = std::clamp(count + (hit.count(cell) != 0 ? 2 : -1), -5, 8);
    }
  }

  const std::map<Voxel, int>& counts() const { return counts_; }

 private:
  static void put(const Eigen::Vector3d& p, std::int32_t out[3]) {
    for (int i = 0; i < 3; ++i)
      out[i] = static_cast<std::int32_t>(
          std::floor((p[i] / kResolution_m + kReach) * (1 << kFractionBits)));
  }

  std::map<Voxel, int> counts_;
};

std::size_t known_cells(const CounterMap& map) {
  std::size_t known = 0;
  for (std::size_t i = 0; i < map.block_count(); ++i)
    for (const std::uint64_t word : map.known(i))
      known += static_cast<std::size_t>(std::popcount(word));
  return known;
}

TEST(CounterMap, CountsWhatASlowMapCounts) {
  SCOPED_TRACE(kSeed);
  const std::vector<Scan> all = scans(12, 150, 4.0);
  const CounterMap map = map_of(all, rules());
  SlowMap slow;
  for (const Scan& scan : all) slow.add(scan);
  EXPECT_GT(slow.counts().size(), 10'000u);
  EXPECT_EQ(known_cells(map), slow.counts().size());
  for (const auto& [cell, count] : slow.counts()) {
    ASSERT_EQ(map.at(cell), count >= 0 ? CellState::kOccupied : CellState::kFree);
    ASSERT_EQ(map.count_at(cell), count);
  }
  EXPECT_EQ(map.at({1000, 0, 0}), CellState::kUnknown);
}

TEST(CounterMap, IsTheSameWithAllInstructions) {
  const std::vector<Scan> all = scans(10, 1000, 20.0);
  const std::uint64_t hash = map_of(all, rules(), Instructions::kPortable).hash();
  EXPECT_NE(hash, CounterMap(kResolution_m).hash());
  for (const Instructions wider : instruction_sets())
    EXPECT_EQ(map_of(all, rules(), wider).hash(), hash) << static_cast<int>(wider);
}

TEST(CounterMap, CountsACellOnceAScanAndAHitBeforeAPass) {
  CounterMap map(kResolution_m);
  RayScratch scratch(rules());
  // Two rays end in a cell which a third one passes.
  const Cloud cloud{0,
                    {{1.05F, 0.05F, 0.05F}, {1.06F, 0.05F, 0.05F}, {2.05F, 0.05F, 0.05F}},
                    std::vector<Eigen::Vector3f>(3, {0.05F, 0.05F, 0.05F})};
  scratch.mark(Pose3::Identity(), cloud);
  map.add(scratch);
  EXPECT_EQ(map.count_at({10, 0, 0}), 2);
  EXPECT_EQ(map.count_at({5, 0, 0}), -1);
  EXPECT_EQ(map.count_at({20, 0, 0}), 2);
}

TEST(CounterMap, TakesAtMostSixTenthsOfAByteForEachCellOfItsBlocks) {
  const CounterMap map = map_of(scans(20, 1000, 20.0), rules());
  EXPECT_GT(map.block_count(), 5000u);
  EXPECT_LE(static_cast<double>(map.memory_bytes()),
            0.6 * 512.0 * static_cast<double>(map.block_count()));
}

TEST(CounterMap, SaysWhichBlocksChangedSinceItWasAsked) {
  const std::vector<Scan> all = scans(2, 50, 3.0);
  RayScratch scratch(rules());
  CounterMap map(kResolution_m);
  scratch.mark(all[0].pose, all[0].cloud);
  map.add(scratch);
  EXPECT_EQ(map.take_changed().size(), map.block_count());
  EXPECT_TRUE(map.take_changed().empty());
  scratch.mark(all[1].pose, all[1].cloud);
  map.add(scratch);
  std::size_t blocks = 0;
  scratch.for_each_block([&](const Voxel&, CellStore::Block, CellStore::Block) { ++blocks; });
  EXPECT_EQ(map.take_changed().size(), blocks);
  for (int i = 0; i < 10; ++i) map.add(scratch);
  EXPECT_EQ(map.take_changed().size(), blocks);
  map.add(scratch);
  EXPECT_TRUE(map.take_changed().empty()) << "all counters are at an end of their range";
}

TEST(RayScratch, KeepsEveryEndAndFollowsAllRaysEquallyFarWhereTheyPassTooMuch) {
  RayRules few = rules();
  few.most_blocks = 2000;
  RayScratch scratch(few);
  const Scan scan = scans(1, 1000, 20.0)[0];
  CounterMap map(kResolution_m);
  ASSERT_TRUE(scratch.mark(scan.pose, scan.cloud));
  map.add(scratch);
  EXPECT_LE(map.block_count(), 3000u);
  EXPECT_GT(map.block_count(), 2000u);
  EXPECT_GT(scratch.reach_m(), 1.0);
  EXPECT_LT(scratch.reach_m(), 20.0);
  for (std::size_t i = 0; i < scan.cloud.points.size(); ++i) {
    const Eigen::Vector3d end = scan.pose * scan.cloud.points[i].cast<double>();
    const Eigen::Vector3d start = scan.pose * scan.cloud.origins[i].cast<double>();
    EXPECT_EQ(map.at(voxel_at(end, kResolution_m)), CellState::kOccupied);
    const double share = 0.95 * scratch.reach_m() / (end - start).norm();
    if (share > 0.9) continue;
    EXPECT_NE(map.at(voxel_at((start + share * (end - start)).eval(), kResolution_m)),
              CellState::kUnknown);
  }
}

TEST(RayScratch, TakesNoMoreThanItsBoundsWhateverTheRays) {
  RayRules fine = rules();
  fine.resolution_m = 0.01;
  fine.max_range_m = 1000.0;
  fine.most_blocks = 10'000;
  RayScratch scratch(fine);
  const Scan scan = scans(1, 2000, 150.0)[0];
  ASSERT_TRUE(scratch.mark(scan.pose, scan.cloud));
  std::size_t blocks = 0, hits = 0;
  scratch.for_each_block([&](const Voxel&, CellStore::Block, CellStore::Block hit) {
    ++blocks;
    for (const std::uint64_t word : hit) hits += static_cast<std::size_t>(std::popcount(word));
  });
  EXPECT_LE(blocks, 12'000u);
  EXPECT_NEAR(static_cast<double>(hits), 2000.0, 5.0);
  EXPECT_LT(scratch.reach_m(), 150.0);
  EXPECT_LE(scratch.used_bytes(), (std::size_t{8} << kMostBlockBits) + 12'002u * 68u + 200u);
}

TEST(RayScratch, FollowsRaysThatLeaveItsBoxAsFarAsThat) {
  CounterMap map(kResolution_m);
  const Cloud cloud{
      0, {{900.0F, 0.05F, 0.05F}, {5.05F, 0.05F, 0.05F}, {-899.95F, 0.05F, 0.05F}}, {}};
  RayRules far = rules();
  far.max_range_m = 1000.0;
  RayScratch scratch(far);
  ASSERT_TRUE(scratch.mark(Pose3::Identity(), cloud));
  map.add(scratch);
  EXPECT_NEAR(scratch.reach_m(), 409.6, 1.0);
  EXPECT_EQ(map.at({9000, 0, 0}), CellState::kOccupied);
  EXPECT_EQ(map.at({-9000, 0, 0}), CellState::kOccupied);
  EXPECT_EQ(map.at({50, 0, 0}), CellState::kOccupied);
  EXPECT_EQ(map.at({4000, 0, 0}), CellState::kFree);
  EXPECT_EQ(map.at({-4000, 0, 0}), CellState::kFree);
  EXPECT_EQ(map.at({5000, 0, 0}), CellState::kUnknown);
}

TEST(RayScratch, TakesTheFirstRayForAllThatEndInOneCellIfItIsToldSo) {
  RayRules one = rules();
  one.every_ray = false;
  const Cloud cloud{0,
                    {{1.04F, 1.04F, 0.05F}, {1.09F, 1.01F, 0.05F}},
                    std::vector<Eigen::Vector3f>(2, {0.05F, 0.05F, 0.05F})};
  RayScratch all(rules()), first(one);
  const auto passed = [&](RayScratch& scratch) {
    scratch.mark(Pose3::Identity(), cloud);
    std::size_t cells = 0;
    scratch.for_each_block([&](const Voxel&, CellStore::Block bits, CellStore::Block) {
      for (const std::uint64_t word : bits) cells += static_cast<std::size_t>(std::popcount(word));
    });
    return cells;
  };
  EXPECT_EQ(passed(first), 21u);
  EXPECT_GT(passed(all), 21u);
}

TEST(RayScratch, StopsWhenItIsTold) {
  RayScratch scratch(rules());
  const Scan scan = scans(1, 1000, 4.0)[0];
  int asked = 0;
  EXPECT_FALSE(scratch.mark(scan.pose, scan.cloud, [&] { return ++asked == 3; }));
  EXPECT_EQ(asked, 3);
}

}  // namespace
}  // namespace voxlist
