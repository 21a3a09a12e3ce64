#include "voxlist/viewing/blocks/block_records.h"

#include <gtest/gtest.h>

#include <cstring>

namespace voxlist::viewing {
namespace {

TEST(BlockRecords, WritePositionLayersTimeAndTheLayersThatAreNotEmpty) {
  MapLevel level;
  level.positions.number({-2, 3, 4});
  level.blocks.push_back({0, 0x1122334455667788, 0, 0, 0, 0, 0, 9});
  level.changed_s.push_back(77);
  BlockSet blocks;
  blocks.add(0);
  const auto record = take_records(level, 10, blocks);
  ASSERT_EQ(record.size(), 6U + 1 + 1 + 4 + 2 * 8);
  const std::vector<std::uint8_t> head{0xfe, 0xff, 3, 0, 4, 0, 0b10000010, 0, 77, 0, 0, 0};
  EXPECT_TRUE(std::equal(head.begin(), head.end(), record.begin()));
  EXPECT_EQ(record[12], 0x88);
  EXPECT_EQ(record[20], 9);
}

TEST(BlockRecords, TakeAtMostSoMany) {
  MapLevel level;
  BlockSet blocks;
  for (std::int32_t i = 0; i < 5; ++i) {
    level.positions.number({i, 0, 0});
    level.blocks.push_back({});
    level.changed_s.push_back(0);
    blocks.add(static_cast<std::uint32_t>(i));
  }
  EXPECT_EQ(take_records(level, 3, blocks).size(), 3U * 12);
  EXPECT_EQ(blocks.size(), 2U);
}

}  // namespace
}  // namespace voxlist::viewing
