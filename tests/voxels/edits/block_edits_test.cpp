#include "voxlist/voxels/edits/block_edits.h"

#include <gtest/gtest.h>

#include <random>

namespace voxlist {
namespace {

constexpr double kResolution_m = 0.08;

Eigen::AlignedBox3d box_at(const Eigen::Vector3d& low, const Eigen::Vector3d& sizes) {
  return {low, (low + sizes).eval()};
}

// Boxes about the origin that overlap, each other one turned.
std::vector<PlacedBox> some_boxes(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> at(-3.0, 1.5), size(0.05, 2.5), turn(-3.0, 3.0);
  std::vector<PlacedBox> boxes;
  for (int i = 0; i < 12; ++i) {
    PlacedBox box{static_cast<EditKind>(i % 3), box_at({at(random), at(random), at(random)},
                                                       {size(random), size(random), size(random)})};
    if (i % 2 == 1) box.T_map_box = {at(random), at(random), turn(random)};
    boxes.push_back(box);
  }
  return boxes;
}

bool is_set(const VoxelBlock& block, int x, int y, int z) {
  return (block[static_cast<std::size_t>(z)] >> (x + 8 * y) & 1) != 0;
}

// What each cell of a block is by the boxes, one by one.
BlockEdits::Cells slowly(const std::vector<PlacedBox>& boxes, const Voxel& block) {
  BlockEdits::Cells cells;
  for (int i = 0; i < 512; ++i) {
    const int x = i % 8, y = i / 8 % 8, z = i / 64;
    const Eigen::Vector3d point =
        center({8 * block.x + x, 8 * block.y + y, 8 * block.z + z}, kResolution_m);
    const PlacedBox* last = nullptr;
    for (const PlacedBox& box : boxes)
      if (box.contains(point)) last = &box;
    if (last) cells.of(last->kind)[static_cast<std::size_t>(z)] |= std::uint64_t{1} << (x + 8 * y);
  }
  return cells;
}

template <class Visit>
void for_each_block_about_origin(const Visit& visit) {
  for (int z = -6; z < 6; ++z)
    for (int y = -6; y < 6; ++y)
      for (int x = -6; x < 6; ++x) visit(Voxel{x, y, z});
}

TEST(BlockEdits, AreWhatTheLastBoxAboutEachCellSays) {
  const auto boxes = some_boxes(1);
  const BlockEdits edits(boxes, kResolution_m);
  std::array<std::size_t, 3> blocks{};
  for_each_block_about_origin([&](const Voxel& block) {
    const auto fast = edits.cells_of(block), slow = slowly(boxes, block);
    EXPECT_EQ(fast.of_kind, slow.of_kind) << block.x << ' ' << block.y << ' ' << block.z;
    for (std::size_t kind = 0; kind < 3; ++kind) blocks[kind] += slow.of_kind[kind] != VoxelBlock{};
  });
  for (const std::size_t some : blocks) EXPECT_GT(some, 30U);
}

TEST(BlockEdits, ListEveryBlockWithCellsOfAKindOnce) {
  const auto boxes = some_boxes(2);
  const BlockEdits edits(boxes, kResolution_m);
  for (const EditKind kind : {EditKind::kErase, EditKind::kKeepFree, EditKind::kKeepBlocked}) {
    Numbering<Voxel> listed;
    for (const Voxel& block : edits.blocks_of(kind)) {
      EXPECT_EQ(listed.find(block), Numbering<Voxel>::kNone);
      listed.number(block);
    }
    std::size_t with_cells = 0;
    for_each_block_about_origin([&](const Voxel& block) {
      if (edits.cells_of(block).of(kind) == VoxelBlock{}) return;
      ++with_cells;
      EXPECT_NE(listed.find(block), Numbering<Voxel>::kNone);
    });
    EXPECT_GT(with_cells, 30U);
  }
}

TEST(BlockEdits, TakeCellsByTheirCentres) {
  const BlockEdits edits({{EditKind::kErase, box_at({0.05, 0.0, 0.0}, {0.1, 0.08, 0.08})}},
                         kResolution_m);
  const VoxelBlock erased = edits.cells_of({0, 0, 0}).of(EditKind::kErase);
  EXPECT_FALSE(is_set(erased, 0, 0, 0));
  EXPECT_TRUE(is_set(erased, 1, 0, 0));
  EXPECT_FALSE(is_set(erased, 2, 0, 0));
  EXPECT_FALSE(is_set(erased, 1, 0, 1));
}

}  // namespace
}  // namespace voxlist
