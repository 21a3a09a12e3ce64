#include "bus/map_chunks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>

#include "bus/wire.h"

namespace voxlist {
namespace {

constexpr double kResolution_m = 0.05;

voxel_block_t block(std::int32_t x, std::int64_t bits) {
  voxel_block_t b{};
  b.x = x;
  b.bits[0] = bits;
  return b;
}

// Version v at time 1000 v: blocks 0 .. n - 1 hold v.
MapChange change(std::int64_t version, std::int64_t base, std::int32_t n_blocks,
                 std::int64_t map_id = 1) {
  MapChange c{1000 * version, map_id, version, base, kResolution_m, {}};
  for (std::int32_t x = 0; x < n_blocks; ++x) c.blocks.push_back(block(x, version));
  return c;
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
  huge.blocks.resize(std::size_t{kMaxChunks} * kBlocksPerChunk + 1);
  EXPECT_THROW(split_map(std::move(huge)), std::length_error);
}

TEST(MapAssembler, AsksUntilItHoldsAMap) {
  MapAssembler assembler;
  EXPECT_TRUE(assembler.needs_request());
  add_all(assembler, split_map(change(5, 4, 10)));
  EXPECT_TRUE(assembler.needs_request());
  EXPECT_FALSE(assembler.held());
  EXPECT_EQ(versions(add_all(assembler, split_map(change(6, kWholeMap, 10)))), Versions{6});
  EXPECT_FALSE(assembler.needs_request());
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
    std::vector<std::int32_t> xs;
    for (const auto& b : changes[0].blocks) xs.push_back(b.x);
    EXPECT_EQ(xs.size(), 10U * kBlocksPerChunk);
    EXPECT_TRUE(std::ranges::is_sorted(xs));
    EXPECT_TRUE(changes[0].is_whole());
    EXPECT_EQ(changes[0].resolution_m, kResolution_m);
  }
}

TEST(MapAssembler, FollowsIncrements) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(1, kWholeMap, 10)));
  for (std::int64_t v = 2; v < 10; ++v) {
    EXPECT_EQ(versions(add_all(assembler, split_map(change(v, v - 1, 5)))), Versions{v});
    EXPECT_FALSE(assembler.needs_request());
  }
}

TEST(MapAssembler, HoldsBackAnIncrementUntilTheOneBeforeItCame) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(1, kWholeMap, 10)));
  EXPECT_TRUE(add_all(assembler, split_map(change(3, 2, 5))).empty());
  EXPECT_TRUE(assembler.needs_request());
  EXPECT_EQ(versions(add_all(assembler, split_map(change(2, 1, 5)))), (Versions{2, 3}));
  EXPECT_FALSE(assembler.needs_request());
}

TEST(MapAssembler, AppliesIncrementsThatArriveWhileAWholeMapIsComingIn) {
  MapAssembler assembler;
  const auto whole = split_map(change(5, kWholeMap, 3 * kBlocksPerChunk));
  assembler.add(whole[0]);
  add_all(assembler, split_map(change(6, 5, 5)));
  assembler.add(whole[1]);
  EXPECT_EQ(versions(assembler.add(whole[2])), (Versions{5, 6}));
  EXPECT_FALSE(assembler.needs_request());
}

TEST(MapAssembler, SeesThatAVersionWasLost) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(1, kWholeMap, 10)));
  EXPECT_TRUE(add_all(assembler, split_map(change(4, 3, 5))).empty());
  EXPECT_TRUE(assembler.needs_request());
  EXPECT_EQ(versions(add_all(assembler, split_map(change(5, kWholeMap, 10)))), Versions{5});
  EXPECT_FALSE(assembler.needs_request());
}

TEST(MapAssembler, SeesALostChunkOnceALaterMessageComes) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(1, kWholeMap, 10)));
  auto messages = split_map(change(2, 1, 3 * kBlocksPerChunk));
  messages.erase(messages.begin() + 1);
  EXPECT_TRUE(add_all(assembler, messages).empty());
  EXPECT_FALSE(assembler.needs_request()) << "it may still come";
  MapChange nothing_new = change(2, 2, 0);
  nothing_new.utime_us += 500;
  add_all(assembler, split_map(nothing_new));
  EXPECT_TRUE(assembler.needs_request());
}

TEST(MapAssembler, PassesOnThatNothingChanged) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(2, kWholeMap, 10)));
  MapChange nothing_new = change(2, 2, 0);
  nothing_new.utime_us = 2500;
  const auto changes = add_all(assembler, split_map(nothing_new));
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].utime_us, 2500);
  EXPECT_TRUE(changes[0].blocks.empty());
  EXPECT_FALSE(assembler.needs_request());
}

TEST(MapAssembler, IgnoresWhatIsOlderThanWhatItHolds) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(5, kWholeMap, 10)));
  EXPECT_TRUE(add_all(assembler, split_map(change(4, kWholeMap, 10))).empty());
  EXPECT_TRUE(add_all(assembler, split_map(change(5, kWholeMap, 10))).empty());
  EXPECT_TRUE(add_all(assembler, split_map(change(5, 4, 10))).empty());
  EXPECT_EQ(assembler.counters().at("stale"), 3);
  EXPECT_EQ(assembler.held()->version, 5);
  EXPECT_FALSE(assembler.needs_request());
}

TEST(MapAssembler, FollowsAMapperThatStartsANewMap) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(50, kWholeMap, 10, 1)));
  EXPECT_EQ(versions(add_all(assembler, split_map(change(0, kWholeMap, 0, 2)))), Versions{0});
  EXPECT_EQ(assembler.held()->map_id, 2);
  EXPECT_EQ(versions(add_all(assembler, split_map(change(1, 0, 5, 2)))), Versions{1});
}

TEST(MapAssembler, AsksWhenItMissedTheStartOfANewMap) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(50, kWholeMap, 10, 1)));
  EXPECT_TRUE(add_all(assembler, split_map(change(51, 50, 5, 2))).empty());
  EXPECT_TRUE(assembler.needs_request());
}

TEST(MapAssembler, FollowsAMapperThatCameBackWithAnOlderVersion) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(50, kWholeMap, 10)));
  MapChange restored = change(48, 48, 0);
  restored.utime_us = 60'000;
  EXPECT_TRUE(add_all(assembler, split_map(restored)).empty());
  EXPECT_TRUE(assembler.needs_request());
  restored.base_version = kWholeMap;
  restored.utime_us = 61'000;
  EXPECT_EQ(versions(add_all(assembler, split_map(restored))), Versions{48});
  EXPECT_FALSE(assembler.needs_request());
}

TEST(MapAssembler, RefusesChunksThatMakeNoSense) {
  MapAssembler assembler;
  const map_update_t good = split_map(change(3, kWholeMap, 2 * kBlocksPerChunk))[0];
  std::vector<map_update_t> bad(14, good);
  bad[0].chunk = 2;
  bad[1].chunk = -1;
  bad[2].n_chunks = 0;
  bad[3].n_chunks = kMaxChunks + 1;
  bad[4].resolution_m = std::numeric_limits<double>::quiet_NaN();
  bad[5].resolution_m = 0.0;
  bad[6].blocks[7].y = kMaxBlockCoordinate;
  bad[7].blocks[7].z = std::numeric_limits<std::int32_t>::min();
  bad[8].version = -1;
  bad[9].base_version = 4;
  bad[10].base_version = -2;
  bad[11].utime = -5;
  bad[12].blocks.push_back(good.blocks[0]);
  bad[13].base_version = 3;
  EXPECT_TRUE(add_all(assembler, bad).empty());
  EXPECT_EQ(assembler.counters().at("bad_chunk"), 14);
}

TEST(MapAssembler, RefusesChunksThatContradictEachOther) {
  MapAssembler assembler;
  auto messages = split_map(change(3, kWholeMap, 2 * kBlocksPerChunk));
  assembler.add(messages[0]);
  messages[1].resolution_m *= 2;
  assembler.add(messages[1]);
  messages[1].resolution_m = kResolution_m;
  messages[1].n_chunks = 3;
  assembler.add(messages[1]);
  EXPECT_EQ(assembler.counters().at("bad_chunk"), 2);
}

TEST(MapAssembler, NeverBuildsOnAMapOfAnotherResolution) {
  MapAssembler assembler;
  add_all(assembler, split_map(change(1, kWholeMap, 5)));
  MapChange finer = change(2, 1, 5);
  finer.resolution_m /= 2;
  EXPECT_TRUE(add_all(assembler, split_map(finer)).empty());
  EXPECT_TRUE(assembler.needs_request());
}

TEST(MapAssembler, KeepsABoundedNumberOfUnfinishedChanges) {
  MapAssembler assembler;
  for (std::int64_t v = 1; v <= 1000; ++v) assembler.add(split_map(change(v, v - 1, 1000))[0]);
  EXPECT_EQ(assembler.counters().at("abandoned"), 1000 - 64);
}

// A listener with a bad line, which asks when it should, always ends with the mapper's map.
TEST(MapAssembler, EndsWithTheMappersMapWhateverTheLineLoses) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    MapAssembler assembler;
    std::map<std::int32_t, std::int64_t> truth;
    std::map<std::int32_t, std::int64_t> held;
    std::vector<map_update_t> line;
    for (std::int64_t v = 1; v <= 100; ++v) {
      const bool lossy = v < 90;
      MapChange increment{1000 * v, 1, v, v - 1, kResolution_m, {}};
      for (std::int32_t i = 0; i < 2000; ++i) {
        increment.blocks.push_back(block(i, v));
        truth[i] = v;
      }
      for (auto& m : split_map(increment)) line.push_back(std::move(m));
      if (assembler.needs_request()) {
        MapChange whole{1000 * v + 1, 1, v, kWholeMap, kResolution_m, {}};
        for (const auto& [x, bits] : truth) whole.blocks.push_back(block(x, bits));
        for (auto& m : split_map(whole)) line.push_back(std::move(m));
      }
      if (lossy && random() % 3 == 0) std::ranges::shuffle(line, random);
      for (const auto& message : line) {
        if (lossy && random() % 10 == 0) continue;
        for (const MapChange& c : assembler.add(message)) {
          if (c.is_whole()) held.clear();
          for (const auto& b : c.blocks) held[b.x] = b.bits[0];
        }
      }
      line.clear();
    }
    EXPECT_EQ(held, truth) << "seed " << seed;
    EXPECT_EQ(assembler.held()->version, 100) << "seed " << seed;
  }
}

}  // namespace
}  // namespace voxlist
