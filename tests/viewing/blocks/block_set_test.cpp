#include "voxlist/viewing/blocks/block_set.h"

#include <gtest/gtest.h>

namespace voxlist::viewing {
namespace {

TEST(BlockSet, HoldsEachNumberOnce) {
  BlockSet blocks;
  for (int i = 0; i < 3; ++i) blocks.add(70);
  EXPECT_EQ(blocks.size(), 1U);
  EXPECT_EQ(blocks.take(), 70U);
  EXPECT_EQ(blocks.take(), std::nullopt);
}

TEST(BlockSet, GivesEachItsTurn) {
  BlockSet blocks;
  blocks.add_all(200);
  for (std::uint32_t i = 0; i < 100; ++i) EXPECT_EQ(blocks.take(), i);
  blocks.add(3);  // changes again and again, and still lets the others through
  EXPECT_EQ(blocks.take(), 100U);
  for (int i = 0; i < 99; ++i) blocks.take();
  EXPECT_EQ(blocks.take(), 3U);
  EXPECT_EQ(blocks.size(), 0U);
}

}  // namespace
}  // namespace voxlist::viewing
