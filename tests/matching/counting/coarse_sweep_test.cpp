#include "voxlist/matching/counting/coarse_sweep.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/system/instruction_sets.h"

namespace voxlist::matching {
namespace {

// A map whose coarse cells number `size_x` by `size_y`, with voxels here and there.
VoxelMap random_map(unsigned seed, std::int32_t size_x, std::int32_t size_y) {
  std::mt19937 random(seed);
  const std::int32_t x = 8 * size_x - 20, y = 8 * size_y - 20;  // faces and windows add the rest
  VoxelMap map(0.25);
  map.insert({0, 0, 0});
  map.insert({x, y, 3});
  for (std::int32_t i = 0; i < size_x * size_y; ++i) {
    const auto at = [&](std::int32_t size) {
      return static_cast<std::int32_t>(random() % static_cast<unsigned>(size));
    };
    map.insert({at(x), at(y), at(4)});
  }
  return map;
}

std::vector<std::int64_t> random_cells(const CoarseMap& map, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::int32_t> place(-2, 2);
  std::vector<std::int64_t> cells;
  for (int i = 0; i < 90; ++i)
    cells.push_back(map.bit(random() % 2 == 0, random() % 2 == 0, place(random), place(random),
                            static_cast<std::int32_t>(random() % 2)));
  return cells;
}

// Looked up bit by bit.
int count_at(const CoarseMap& map, const std::vector<std::int64_t>& cells, std::int32_t x,
             std::int32_t y) {
  int count = 0;
  for (const std::int64_t cell : cells) {
    const auto bit = static_cast<std::size_t>(cell + y * map.row_bits() + x);
    count += static_cast<int>(map.words()[bit / 64] >> bit % 64 & 1);
  }
  return count;
}

int count_in(const NodeCounts& counts, std::size_t bit) {
  int count = 0;
  for (std::size_t p = 0; p < kCountPlanes; ++p)
    count |= static_cast<int>(counts.planes[p * counts.words + bit / 64] >> bit % 64 & 1) << p;
  return count;
}

void expect_counts_of_a_plain_loop(std::int32_t size_x, std::int32_t size_y) {
  SCOPED_TRACE(testing::Message() << size_x << " x " << size_y);
  const auto seed = static_cast<unsigned>(size_x);
  const DilatedMap dilated(random_map(seed, size_x, size_y), 0.25, 4.0);
  const CoarseMap map(dilated, 4.0);
  ASSERT_EQ(map.size_x(), size_x);
  ASSERT_EQ(map.size_y(), size_y);
  const std::vector<std::int64_t> cells = random_cells(map, seed + 1);
  for (const Instructions instructions : instruction_sets()) {
    const NodeCounts counts = coarse_sweep(map, cells, instructions);
    std::int64_t total = 0;
    for (std::int32_t y = 0; y < size_y; ++y)
      for (std::int32_t x = 0; x < size_x; ++x) {
        const int expected = count_at(map, cells, x, y);
        ASSERT_EQ(count_in(counts, static_cast<std::size_t>(y * map.row_bits() + x)), expected)
            << x << ' ' << y << ", instructions " << static_cast<int>(instructions);
        total += expected;
      }
    EXPECT_GT(total, 0);
  }
}

TEST(CoarseSweep, CountsLikeAPlainLoopForAllWidthsAndInstructions) {
  // Rows have margins of 2 x 5 coarse cells; so both maps and rows come around 64, 256 and 512.
  for (const std::int32_t width :
       {3, 53, 54, 55, 63, 64, 65, 245, 246, 247, 255, 256, 257, 501, 502, 503, 511, 512, 513})
    expect_counts_of_a_plain_loop(width, 3);
  for (const std::int32_t height : {3, 7, 64, 65}) expect_counts_of_a_plain_loop(9, height);
}

TEST(CoarseSweep, CountsUpToTheLastPlane) {
  const CoarseMap map(DilatedMap(random_map(1, 20, 5), 0.25, 4.0), 4.0);
  const std::int64_t bit = map.bit(true, true, 0, 0, 0);
  for (const Instructions instructions : instruction_sets()) {
    const NodeCounts counts = coarse_sweep(map, std::vector<std::int64_t>(1023, bit), instructions);
    EXPECT_EQ(count_in(counts, 0), 1023);  // cell (0, 0, 0) of the map is occupied
  }
}

TEST(CoarseSweep, CountsNothingForNoCells) {
  const CoarseMap map(DilatedMap(random_map(1, 20, 5), 0.25, 4.0), 4.0);
  for (const Instructions instructions : instruction_sets()) {
    const NodeCounts counts = coarse_sweep(map, {}, instructions);
    EXPECT_EQ(counts.planes.size(), kCountPlanes * counts.words);
    EXPECT_GT(counts.words, 0u);
    for (const std::uint64_t word : counts.planes) EXPECT_EQ(word, 0u);
  }
}

TEST(CoarseMap, GridsHoldTheCellsAheadUpToTheirWidth) {
  const DilatedMap dilated(random_map(5, 9, 6), 0.25, 4.0);
  const CoarseMap map(dilated, 4.0);
  for (const bool wide_x : {false, true})
    for (const bool wide_y : {false, true})
      for (std::int32_t z = 0; z < dilated.size_z(); ++z)
        for (std::int32_t y = -4; y < map.size_y() + 4; ++y)
          for (std::int32_t x = -4; x < map.size_x() + 4; ++x) {
            std::uint64_t any = 0;
            for (std::int32_t j = 0; j < (wide_y ? 3 : 2); ++j)
              for (std::int32_t i = 0; i < (wide_x ? 3 : 2); ++i)
                any |= dilated.window_anywhere(8 * (x + i), 8 * (y + j), z);
            const auto bit = static_cast<std::size_t>(map.bit(wide_x, wide_y, x, y, z));
            ASSERT_EQ(map.words()[bit / 64] >> bit % 64 & 1, std::uint64_t{any != 0})
                << wide_x << wide_y << ' ' << x << ' ' << y << ' ' << z;
          }
}

}  // namespace
}  // namespace voxlist::matching
