#include "tests/matching/counting/overlap_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <stdexcept>

#include "tests/system/instruction_sets.h"
#include "voxlist/matching/paper/overlap.h"

namespace voxlist::matching {
namespace {

constexpr Voxel kLow{-40, -9, -3}, kHigh{1000, 20, 6};

std::vector<Voxel> random_voxels(std::mt19937& random, std::size_t count, const Voxel& low,
                                 const Voxel& high) {
  const auto between = [&random](std::int32_t a, std::int32_t b) {
    return std::uniform_int_distribution<std::int32_t>(a, b)(random);
  };
  std::set<Voxel> voxels;
  while (voxels.size() < count)
    voxels.insert({between(low.x, high.x), between(low.y, high.y), between(low.z, high.z)});
  return {voxels.begin(), voxels.end()};
}

VoxelMap random_map(unsigned seed) {
  std::mt19937 random(seed);
  VoxelMap map;
  for (const Voxel& v : random_voxels(random, 60'000, kLow, {1100, 25, 8})) map.insert(v);
  return map;
}

void expect_overlaps(std::size_t voxels, const TranslationBlock& block) {
  SCOPED_TRACE(testing::Message() << voxels << " voxels, " << block.columns << " x " << block.rows);
  std::mt19937 random(static_cast<unsigned>(voxels));
  const VoxelMap map = random_map(3);
  const RowMap rows(map, kLow, kHigh);
  const std::vector<Voxel> scan = random_voxels(random, voxels, {-20, -5, -2}, {300, 9, 4});
  std::vector<std::uint16_t> expected;
  for (std::int32_t j = 0; j < block.rows; ++j)
    for (std::int32_t i = 0; i < block.columns; ++i)
      expected.push_back(static_cast<std::uint16_t>(
          overlap(scan, map, {block.first.x + i, block.first.y + j, block.first.z})));
  for (const Instructions instructions : instruction_sets()) {
    std::vector<std::uint16_t> counts(expected.size(), 77);
    overlap_rows(rows, scan, block, instructions, counts);
    EXPECT_EQ(counts, expected) << "instructions " << static_cast<int>(instructions);
  }
  EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 0);
}

TEST(OverlapRows, AreTheOverlapsOneByOneForAllInstructions) {
  for (const std::int32_t columns : {1, 7, 8, 63, 64, 65, 511, 512, 513, 690})
    expect_overlaps(100, {{-20, -4, 1}, columns, 3});
  expect_overlaps(100, {{-20, -4, -1}, 5, 16});
}

TEST(OverlapRows, CountScansOfAnySize) {
  for (const std::size_t voxels : {1, 7, 8, 9, 1015, 1016, 1017, 1024, 4500})
    expect_overlaps(voxels, {{-20, -4, 1}, 70, 2});
}

TEST(OverlapRows, CountUpToAllVoxels) {
  VoxelMap map;
  std::vector<Voxel> scan;
  for (std::int32_t x = 0; x < 100; ++x)
    for (std::int32_t y = 0; y < 90; ++y) {
      scan.push_back({x, y, 0});
      map.insert({x + 3, y + 1, 2});
    }
  for (const Instructions instructions : instruction_sets()) {
    std::vector<std::uint16_t> counts(1);
    overlap_rows(RowMap(map, {0, 0, 0}, {200, 200, 3}), scan, {{3, 1, 2}, 1, 1}, instructions,
                 counts);
    EXPECT_EQ(counts[0], 9000);
  }
}

TEST(OverlapRows, RefuseWhatLeavesTheMapsBoxAndCountsOfAnotherSize) {
  const RowMap map(random_map(1), kLow, kHigh);
  const std::vector<Voxel> scan{{0, 0, 0}, {10, 10, 2}};
  const auto count = [&](const Voxel& first, std::int32_t columns, std::int32_t rows,
                         std::size_t size) {
    std::vector<std::uint16_t> counts(size);
    overlap_rows(map, scan, {first, columns, rows}, Instructions::kPortable, counts);
  };
  EXPECT_NO_THROW(count({-40, -9, -3}, 1031, 20, 1031 * 20));
  EXPECT_THROW(count({-41, -9, -3}, 2, 2, 4), std::invalid_argument);
  EXPECT_THROW(count({-40, -9, -3}, 1032, 1, 1032), std::invalid_argument);
  EXPECT_THROW(count({-40, -9, -3}, 1, 21, 21), std::invalid_argument);
  EXPECT_THROW(count({0, 0, 5}, 1, 1, 1), std::invalid_argument);
  EXPECT_THROW(count({0, 0, 0}, 2, 2, 5), std::invalid_argument);
  EXPECT_THROW(count({0, 0, 0}, -1, -4, 4), std::invalid_argument);
}

}  // namespace
}  // namespace voxlist::matching
