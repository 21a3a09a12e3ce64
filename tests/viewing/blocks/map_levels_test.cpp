#include "voxlist/viewing/blocks/map_levels.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "tests/viewing/blocks/map_change.h"

namespace voxlist::viewing {
namespace {

constexpr std::size_t kAllWork = std::numeric_limits<std::size_t>::max() / 4;

std::set<Voxel> voxels_of(const MapLevel& level) {
  std::set<Voxel> voxels;
  for (std::uint32_t i = 0; i < level.size(); ++i)
    VoxelMap::visit_block(level.positions.key(i), level.blocks[i],
                          [&](const Voxel& v) { voxels.insert(v); });
  return voxels;
}

TEST(MapLevels, ShowTheMapAndFourTimesCoarser) {
  MapLevels levels(0.05);
  levels.apply(whole_map({{0, 0, 0}, {1, 0, 0}, {-1, 9, 3}}));
  levels.refresh(kAllWork);
  EXPECT_EQ(voxels_of(levels.level(kFine)), (std::set<Voxel>{{0, 0, 0}, {1, 0, 0}, {-1, 9, 3}}));
  EXPECT_EQ(voxels_of(levels.level(kCoarse)), (std::set<Voxel>{{0, 0, 0}, {-1, 2, 0}}));
}

TEST(MapLevels, AreNoFinerThanTheMap) {
  MapLevels levels(0.04);
  levels.apply(whole_map({{0, 0, 0}}));
  EXPECT_EQ(levels.level(kFine).edge_m, 0.05);
}

TEST(MapLevels, WorkOffTheCoarseOneFirst) {
  MapLevels levels(0.05);
  levels.apply(whole_map({{0, 0, 0}, {500, 0, 0}}));
  levels.refresh(150);  // one block of the coarse level
  ASSERT_EQ(levels.take_changed().size(), 1U);
  EXPECT_FALSE(levels.is_fresh());
  levels.refresh(kAllWork);
  EXPECT_TRUE(levels.is_fresh());
  EXPECT_EQ(levels.take_changed().size(), 3U);
}

TEST(MapLevels, LoseWhatTheMapHasLost) {
  MapLevels levels(0.05);
  levels.apply(whole_map({{0, 0, 0}, {100, 0, 0}}));
  levels.refresh(kAllWork);
  bus::MapChange emptied = changed_map({{0, 0, 0}}, 2);
  for (voxel_block_t& block : emptied.blocks.occupied)
    for (std::int64_t& layer : block.bits) layer = 0;
  levels.apply(emptied);
  levels.refresh(kAllWork);
  EXPECT_EQ(voxels_of(levels.level(kFine)), (std::set<Voxel>{{100, 0, 0}}));
  EXPECT_EQ(voxels_of(levels.level(kCoarse)), (std::set<Voxel>{{25, 0, 0}}));
}

TEST(MapLevels, TellOnlyWhatIsOtherInAWholeMapOfTheSameId) {
  MapLevels levels(0.05);
  levels.apply(whole_map({{0, 0, 0}, {100, 0, 0}}));
  levels.refresh(kAllWork);
  levels.take_changed();
  const std::uint32_t epoch = levels.epoch();
  levels.apply(whole_map({{0, 0, 0}, {200, 0, 0}}));
  levels.refresh(kAllWork);
  EXPECT_EQ(levels.epoch(), epoch);
  EXPECT_EQ(levels.take_changed().size(), 4U);  // one gone, one come, at each level
  EXPECT_EQ(voxels_of(levels.level(kFine)), (std::set<Voxel>{{0, 0, 0}, {200, 0, 0}}));
}

TEST(MapLevels, BeginAnewWithAnotherMap) {
  MapLevels levels(0.05);
  levels.apply(whole_map({{0, 0, 0}}, 1));
  levels.refresh(kAllWork);
  const std::uint32_t epoch = levels.epoch();
  levels.apply(whole_map({{8, 0, 0}}, 2));
  levels.refresh(kAllWork);
  EXPECT_NE(levels.epoch(), epoch);
  EXPECT_EQ(voxels_of(levels.level(kFine)), (std::set<Voxel>{{8, 0, 0}}));
}

TEST(MapLevels, KnowWhenABlockChanged) {
  MapLevels levels(0.05);
  levels.apply(whole_map({{0, 0, 0}, {100, 0, 0}}));
  levels.refresh(kAllWork);
  levels.apply(changed_map({{1, 0, 0}}, 2));
  levels.refresh(kAllWork);
  const MapLevel& fine = levels.level(kFine);
  EXPECT_EQ(fine.changed_s[fine.positions.find({0, 0, 0})], 7U);
  EXPECT_EQ(fine.changed_s[fine.positions.find({12, 0, 0})], 5U);
}

}  // namespace
}  // namespace voxlist::viewing
