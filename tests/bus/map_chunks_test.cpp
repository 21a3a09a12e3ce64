#include "voxlist/bus/map_chunks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
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
  EXPECT_EQ(changes[0].blocks.size(), 0U);
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
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<map_update_t> bad(21, good);
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
  bad[14].passed_resolution_m = std::numeric_limits<double>::quiet_NaN();
  bad[15].passed_resolution_m = kInfinity;
  bad[16].passed_resolution_m = -0.2;
  bad[17].passed_resolution_m = 0.9 * kResolution.occupied_m;
  bad[18].passed_resolution_m = 11.0;
  bad[19].passed_blocks.push_back(good.blocks[0]);
  bad[20].blocks.pop_back();
  bad[20].passed_blocks.push_back(block(kMaxBlockCoordinate, 1));
  for (const auto& message : bad) EXPECT_TRUE(assembler.add(message).empty());
  EXPECT_EQ(assembler.counters().at("bad_chunk"), 21);
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
    EXPECT_TRUE(assembler.needs_request());
  }
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
    std::map<std::int32_t, std::int64_t> truth, passed_truth;
    std::map<std::int32_t, std::int64_t> held, passed;
    std::vector<map_update_t> line;
    for (std::int64_t v = 1; v <= 100; ++v) {
      const bool lossy = v < 90;
      const MapChange increment = change(v, v - 1, 2000);
      for (const auto& b : increment.blocks.occupied) truth[b.x] = v;
      for (const auto& b : increment.blocks.passed) passed_truth[b.x] = -v;
      for (auto& m : split_map(increment)) line.push_back(std::move(m));
      if (assembler.needs_request()) {
        MapChange whole{1000 * v + 1, 1, v, kWholeMap, kResolution, {}};
        for (const auto& [x, bits] : truth) whole.blocks.occupied.push_back(block(x, bits));
        for (const auto& [x, bits] : passed_truth) whole.blocks.passed.push_back(block(x, bits));
        for (auto& m : split_map(whole)) line.push_back(std::move(m));
      }
      if (lossy && random() % 3 == 0) std::ranges::shuffle(line, random);
      for (const auto& message : line) {
        if (lossy && random() % 10 == 0) continue;
        for (const MapChange& c : assembler.add(message)) {
          if (c.is_whole()) held.clear(), passed.clear();
          for (const auto& b : c.blocks.occupied) held[b.x] = b.bits[0];
          for (const auto& b : c.blocks.passed) passed[b.x] = b.bits[0];
        }
      }
      line.clear();
    }
    EXPECT_EQ(held, truth) << "seed " << seed;
    EXPECT_EQ(passed, passed_truth) << "seed " << seed;
    EXPECT_EQ(assembler.held()->version, 100) << "seed " << seed;
  }
}

}  // namespace
}  // namespace voxlist::bus
