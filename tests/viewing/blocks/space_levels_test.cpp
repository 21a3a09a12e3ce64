#include "voxlist/viewing/blocks/space_levels.h"

#include <gtest/gtest.h>

#include <vector>

#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::viewing {
namespace {

bus::MapChange change_to(const OccupancyMap& cells, std::int64_t map_id = 1) {
  bus::MapChange change;
  change.utime_us = 5'000'000;
  change.map_id = map_id;
  change.version = 1;
  change.resolution = bus::resolution_of(cells);
  change.blocks = bus::to_messages(cells);
  return change;
}

OccupancyMap cells_of(const std::vector<Voxel>& free, const std::vector<Voxel>& occupied) {
  OccupancyMap cells{VoxelMap(0.08), VoxelMap(0.08)};
  for (const Voxel& v : free) cells.passed.insert(v);
  for (const Voxel& v : occupied) cells.occupied.insert(v);
  return cells;
}

TEST(SpaceLevels, HoldTheChannelsOwnCells) {
  SpaceLevels space;
  space.apply(change_to(cells_of({{0, 0, 0}, {1, 0, 0}}, {{20, 0, 0}})));
  EXPECT_EQ(space.level(kFreeCells).edge_m, 0.08);
  ASSERT_EQ(space.level(kFreeCells).size(), 1U);
  EXPECT_EQ(space.level(kFreeCells).blocks[0][0], 3U);
  ASSERT_EQ(space.level(kOccupiedCells).size(), 1U);
  EXPECT_EQ(space.level(kOccupiedCells).positions.key(0), (Voxel{2, 0, 0}));
  EXPECT_EQ(space.take_changed().size(), 2U);
  EXPECT_TRUE(space.take_changed().empty());
}

TEST(SpaceLevels, TellOnlyWhatAWholeMapOfTheSameIdChanges) {
  SpaceLevels space;
  space.apply(change_to(cells_of({{0, 0, 0}, {80, 0, 0}}, {})));
  const std::uint32_t epoch = space.epoch();
  space.take_changed();
  space.apply(change_to(cells_of({{0, 0, 0}}, {})));
  EXPECT_EQ(space.take_changed().size(), 1U) << "the block that is empty now";
  EXPECT_EQ(space.epoch(), epoch);
  space.apply(change_to(cells_of({{0, 0, 0}}, {}), 2));
  EXPECT_NE(space.epoch(), epoch);
}

TEST(SpaceLevels, ForgetOnce) {
  SpaceLevels space;
  space.apply(change_to(cells_of({{0, 0, 0}}, {})));
  space.forget();
  const std::uint32_t epoch = space.epoch();
  space.forget();
  EXPECT_EQ(space.epoch(), epoch);
  EXPECT_EQ(space.level(kFreeCells).size(), 0U);
}

}  // namespace
}  // namespace voxlist::viewing
