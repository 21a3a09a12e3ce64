#include "voxlist/voxels/voids/free_neighbours.h"

#include <gtest/gtest.h>

#include <random>

namespace voxlist {
namespace {

VoxelBlock random_block(std::mt19937_64& random) {
  VoxelBlock block;
  for (std::uint64_t& word : block) word = random() | random();
  return block;
}

TEST(FreeNeighbours, KeepsEachCellFromTheOrderOfKeysToRowsAndBack) {
  for (std::size_t bit = 0; bit < 512; ++bit) {
    BlockBits keys{};
    keys[bit / 64] = std::uint64_t{1} << bit % 64;
    const VoxelBlock rows = in_rows(CellStore::Block(keys));
    const Voxel cell = cell_of_bit(bit);
    std::vector<Voxel> cells;
    VoxelMap::visit_block({0, 0, 0}, rows, [&](const Voxel& v) { cells.push_back(v); });
    EXPECT_EQ(cells, std::vector{cell});
    EXPECT_EQ(in_keys(rows), keys);
  }
}

TEST(FreeNeighbours, CountsTheCubeAboutEachCellAcrossBlocks) {
  std::mt19937_64 random(1);
  VoxelMap map(1.0);
  std::array<VoxelBlock, 27> held;
  BlocksAround blocks;
  for (std::int32_t i = 0; i < 27; ++i) {
    const auto at = static_cast<std::size_t>(i);
    held[at] = random_block(random);
    blocks[at] = i % 5 == 0 ? nullptr : &held[at];
    if (blocks[at]) map.set_block({i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}, held[at]);
  }
  const auto around = [&](const Voxel& v) {
    unsigned count = 0;
    for (std::int32_t z = -1; z <= 1; ++z)
      for (std::int32_t y = -1; y <= 1; ++y)
        for (std::int32_t x = -1; x <= 1; ++x) count += map.contains({v.x + x, v.y + y, v.z + z});
    return count;
  };
  for (const unsigned fewest : {1u, 12u, 18u, 22u, 27u}) {
    VoxelMap wide(1.0);
    wide.set_block({0, 0, 0}, with_marked_around(blocks, fewest));
    for (std::int32_t i = 0; i < 512; ++i) {
      const Voxel v{i % 8, i / 8 % 8, i / 64};
      ASSERT_EQ(wide.contains(v), around(v) >= fewest) << i << ' ' << fewest;
    }
  }
}

}  // namespace
}  // namespace voxlist
