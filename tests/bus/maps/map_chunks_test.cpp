#include "voxlist/bus/maps/map_chunks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <stdexcept>

#include "voxlist/bus/wire.h"

namespace voxlist::bus {
namespace {

constexpr MapResolution kResolution{0.05, 0.2};

voxel_block_t block(std::int32_t x, std::int64_t bits) {
  voxel_block_t b{};
  b.x = x;
  b.bits[0] = bits;
  return b;
}

// Version v at time 1000 v: blocks 0 .. n - 1 hold v, a third of them as passed cells.
MapChange change(std::int64_t version, std::int64_t base, std::int32_t n_blocks,
                 std::int64_t map_id = 1) {
  MapChange c{1000 * version, map_id, version, base, kResolution, {}};
  const std::int32_t n_passed = n_blocks / 3;
  for (std::int32_t x = 0; x < n_blocks - n_passed; ++x)
    c.blocks.occupied.push_back(block(x, version));
  for (std::int32_t x = 0; x < n_passed; ++x) c.blocks.passed.push_back(block(x, -version));
  return c;
}

std::vector<std::int32_t> xs_of(const std::vector<voxel_block_t>& blocks) {
  std::vector<std::int32_t> xs;
  for (const auto& b : blocks) xs.push_back(b.x);
  return xs;
}

std::vector<MapChange> add_all(MapAssembler& assembler, const std::vector<map_update_t>& messages) {
  std::vector<MapChange> changes;
  for (const auto& message : messages) {
    for (auto& c : assembler.add(message)) changes.push_back(std::move(c));
  }
  return changes;
}

std::vector<std::int64_t> versions(const std::vector<MapChange>& changes) {
  std::vector<std::int64_t> all;
  for (const auto& c : changes) all.push_back(c.version);
  return all;
}

using Versions = std::vector<std::int64_t>;

TEST(SplitMap, MakesMessagesThatFitOnePacket) {
  const auto messages = split_map(change(3, kWholeMap, 2000));
  ASSERT_EQ(messages.size(), 3U);
  for (const auto& message : messages) {
    std::vector<std::uint8_t> bytes;
    ASSERT_EQ(encode(message, bytes), Fault::kNone);
    EXPECT_LE(bytes.size(), 60'000U);
  }
}

TEST(SplitMap, MakesOneMessageOfNoBlocks) {
  EXPECT_EQ(split_map(change(0, kWholeMap, 0)).size(), 1U);
}

TEST(SplitMap, RefusesAMapThatNoListenerWouldAccept) {
  MapChange huge = change(1, kWholeMap, 0);
  huge.blocks.occupied.resize(std::size_t{kMaxChunks} * kBlocksPerChunk / 2 + 1);
  huge.blocks.passed.resize(std::size_t{kMaxChunks} * kBlocksPerChunk / 2);
  EXPECT_THROW(split_map(std::move(huge)), std::length_error);
}

TEST(SplitMap, FillsEveryMessageButTheLastFromBothLists) {
  const auto messages = split_map(change(3, kWholeMap, 3 * kBlocksPerChunk));
  ASSERT_EQ(messages.size(), 3U);
  for (const auto& message : messages) {
    EXPECT_EQ(message.n_blocks + message.n_passed_blocks, kBlocksPerChunk);
    EXPECT_EQ(message.resolution_m, kResolution.occupied_m);
    EXPECT_EQ(message.passed_resolution_m, kResolution.passed_m);
  }
  EXPECT_EQ(messages[1].n_passed_blocks, 0);
  EXPECT_EQ(messages[2].n_blocks, 0);
  EXPECT_EQ(split_map(change(3, kWholeMap, kBlocksPerChunk))[0].n_passed_blocks,
            kBlocksPerChunk / 3);
}

TEST(MapAssembler, HoldsNothingBeforeAWholeMap) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(5, 4, 10)));
  EXPECT_FALSE(assembler.held());
  EXPECT_EQ(versions(add_all(assembler, split_map(change(6, kWholeMap, 10)))), Versions{6});
  ASSERT_TRUE(assembler.held());
  EXPECT_EQ(assembler.held()->version, 6);
}

TEST(MapAssembler, PutsChunksTogetherInAnyOrderWithDuplicates) {
  constexpr std::uint32_t kSeed = 5;
  std::mt19937 random(kSeed);
  auto messages = split_map(change(1, kWholeMap, 10 * kBlocksPerChunk));
  for (std::size_t i = 0; i < 5; ++i) messages.push_back(messages[i]);
  for (int round = 0; round < 50; ++round) {
    std::ranges::shuffle(messages, random);
    MapAssembler assembler;
    const auto changes = add_all(assembler, messages);
    ASSERT_EQ(changes.size(), 1U) << "seed " << kSeed << " round " << round;
    const auto occupied = xs_of(changes[0].blocks.occupied);
    const auto passed = xs_of(changes[0].blocks.passed);
    EXPECT_EQ(occupied.size() + passed.size(), 10U * kBlocksPerChunk);
    EXPECT_EQ(passed.size(), 10U * kBlocksPerChunk / 3);
    EXPECT_TRUE(std::ranges::is_sorted(occupied));
    EXPECT_TRUE(std::ranges::is_sorted(passed));
    EXPECT_TRUE(changes[0].is_whole());
    EXPECT_EQ(changes[0].resolution, kResolution);
  }
}

TEST(MapAssembler, FollowsIncrements) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(1, kWholeMap, 10)));
  for (std::int64_t v = 2; v < 10; ++v) {
    EXPECT_EQ(versions(add_all(assembler, split_map(change(v, v - 1, 5)))), Versions{v});
  }
}

TEST(MapAssembler, HoldsBackAnIncrementUntilTheOneBeforeItCame) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(1, kWholeMap, 10)));
  EXPECT_TRUE(add_all(assembler, split_map(change(3, 2, 5))).empty());
  EXPECT_EQ(versions(add_all(assembler, split_map(change(2, 1, 5)))), (Versions{2, 3}));
}

TEST(MapAssembler, AppliesIncrementsThatArriveWhileAWholeMapIsComingIn) {
  MapAssembler assembler;
  const auto whole = split_map(change(5, kWholeMap, 3 * kBlocksPerChunk));
  assembler.add(whole[0]);
  add_all(assembler, split_map(change(6, 5, 5)));
  assembler.add(whole[1]);
  EXPECT_EQ(versions(assembler.add(whole[2])), (Versions{5, 6}));
}

TEST(MapAssembler, WaitsForAWholeMapWhenAVersionWasLost) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(1, kWholeMap, 10)));
  EXPECT_TRUE(add_all(assembler, split_map(change(4, 3, 5))).empty());
  EXPECT_EQ(versions(add_all(assembler, split_map(change(5, kWholeMap, 10)))), Versions{5});
}

TEST(MapAssembler, PutsAWholeMapTogetherOfTwoSendings) {
  MapAssembler assembler;
  auto messages = split_map(change(2, kWholeMap, 3 * kBlocksPerChunk));
  const map_update_t second = messages[1];
  messages.erase(messages.begin() + 1);
  EXPECT_TRUE(add_all(assembler, messages).empty());
  auto again = second;
  again.utime += 500;
  EXPECT_EQ(versions(assembler.add(again)), Versions{2});
  EXPECT_EQ(assembler.held()->utime_us, 2500);
}

TEST(MapAssembler, PassesOnThatNothingChanged) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(2, kWholeMap, 10)));
  MapChange nothing_new = change(2, 2, 0);
  nothing_new.utime_us = 2500;
  const auto changes = add_all(assembler, split_map(nothing_new));
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].utime_us, 2500);
  EXPECT_EQ(changes[0].blocks.size(), 0U);
}

TEST(MapAssembler, IgnoresWhatIsOlderThanWhatItHolds) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(5, kWholeMap, 10)));
  EXPECT_TRUE(add_all(assembler, split_map(change(4, kWholeMap, 10))).empty());
  EXPECT_TRUE(add_all(assembler, split_map(change(5, kWholeMap, 10))).empty());
  EXPECT_TRUE(add_all(assembler, split_map(change(5, 4, 10))).empty());
  EXPECT_EQ(assembler.counters().at("older"), 3);
  EXPECT_EQ(assembler.held()->version, 5);
}

TEST(MapAssembler, FollowsAMapperThatStartsANewMap) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(50, kWholeMap, 10, 1)));
  EXPECT_EQ(versions(add_all(assembler, split_map(change(0, kWholeMap, 0, 2)))), Versions{0});
  EXPECT_EQ(assembler.held()->map_id, 2);
  EXPECT_EQ(versions(add_all(assembler, split_map(change(1, 0, 5, 2)))), Versions{1});
}

TEST(MapAssembler, TakesAnOlderVersionOnceItHasForgotten) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(50, kWholeMap, 10)));
  MapChange restored = change(48, kWholeMap, 10);
  restored.utime_us = 90'000;
  EXPECT_TRUE(add_all(assembler, split_map(restored)).empty());
  assembler.forget();
  EXPECT_FALSE(assembler.held());
  EXPECT_EQ(versions(add_all(assembler, split_map(restored))), Versions{48});
}

TEST(MapAssembler, AForgedTimeShutsNothingOut) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(1, kWholeMap, 10)));
  MapChange forged = change(1, 1, 0);
  forged.utime_us = 9'000'000;
  add_all(assembler, split_map(forged));
  EXPECT_EQ(versions(add_all(assembler, split_map(change(2, 1, 5)))), Versions{2});
  EXPECT_EQ(assembler.held()->utime_us, 2000);
}

TEST(MapAssembler, RefusesAnIncrementFarFromItsMap) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(1, kWholeMap, 10)));
  MapChange far = change(2, 1, 10);
  far.blocks.occupied[0].y = 5100;  // 2040 m
  EXPECT_TRUE(add_all(assembler, split_map(far)).empty());
  EXPECT_EQ(assembler.counters().at("far_block"), 1);
  far.blocks.occupied[0].y = 4900;
  EXPECT_EQ(versions(add_all(assembler, split_map(far))), Versions{2});
}

TEST(MapAssembler, RefusesPassedCellsWhereNothingChanged) {
  MapAssembler assembler;
  map_update_t message = split_map(change(3, 3, 0))[0];
  message.passed_blocks.push_back(block(1, 1));
  assembler.add(message);
  EXPECT_EQ(assembler.counters().at("bad_chunk"), 1);
}

TEST(MapAssembler, RefusesChunksThatContradictEachOther) {
  MapAssembler assembler;
  auto messages = split_map(change(3, kWholeMap, 2 * kBlocksPerChunk));
  assembler.add(messages[0]);
  messages[1].resolution_m *= 2;
  assembler.add(messages[1]);
  messages[1].resolution_m = kResolution.occupied_m;
  messages[1].passed_resolution_m *= 2;
  assembler.add(messages[1]);
  messages[1].passed_resolution_m = kResolution.passed_m;
  messages[1].n_chunks = 3;
  assembler.add(messages[1]);
  EXPECT_EQ(assembler.counters().at("bad_chunk"), 3);
}

TEST(MapAssembler, NeverBuildsOnAMapOfAnotherResolution) {
  for (const MapResolution other : {MapResolution{0.025, 0.2}, MapResolution{0.05, 0.1}}) {
    MapAssembler assembler;
    add_all(assembler, split_map(change(1, kWholeMap, 5)));
    MapChange finer = change(2, 1, 5);
    finer.resolution = other;
    EXPECT_TRUE(add_all(assembler, split_map(finer)).empty());
  }
}

TEST(MapAssembler, KeepsABoundedNumberOfUnfinishedChanges) {
  MapAssembler assembler;
  for (std::int64_t v = 1; v <= 1000; ++v) assembler.add(split_map(change(v, v - 1, 1000))[0]);
  EXPECT_EQ(assembler.counters().at("abandoned"), 1000 - 64);
}

}  // namespace
}  // namespace voxlist::bus
