#include "voxlist/service/inputs/map_follower.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <voxlist/health_t.hpp>

#include "tests/stand_in_mapper.h"

namespace voxlist::service {
namespace {

using test::StandInMapper;
using ::testing::HasSubstr;
constexpr std::int64_t kSecond_us = 1'000'000;
constexpr std::int64_t kMine = 7, kOther = 8;

voxel_block_t block(std::int32_t x, std::int64_t bits) {
  voxel_block_t b{};
  b.x = x;
  b.bits[0] = bits;
  return b;
}

// A whole map of 10 blocks that hold its version, unless it is empty.
bus::MapChange whole(std::int64_t map_id, std::int64_t version) {
  bus::MapChange map{1000 * version, map_id, version, bus::kWholeMap, {0.02, 0.08}, {}};
  for (std::int32_t x = 0; version > 0 && x < 10; ++x)
    map.blocks.occupied.push_back(block(x, version));
  return map;
}

// Block 0 of the next version.
bus::MapChange increment(std::int64_t map_id, std::int64_t version) {
  bus::MapChange change = whole(map_id, version);
  change.base_version = version - 1;
  change.blocks.occupied.resize(1);
  return change;
}

// A listener and its mappers, on a line that brings everything at once.
struct Line {
  void hear(const std::vector<map_update_t>& messages) {
    for (const map_update_t& message : messages) hear(message);
  }
  void hear(const map_update_t& message) {
    for (const bus::MapChange& change : follower.take(message)) {
      if (change.is_whole()) blocks.clear();
      for (const voxel_block_t& b : change.blocks.occupied) blocks[b.x] = b.bits[0];
    }
  }
  // Mappers answer at once, in their order.
  void run(double seconds) {
    const std::int64_t end_us = now_us + std::int64_t(seconds * 1e6);
    for (; now_us < end_us; now_us += kSecond_us / 50) {
      const auto request = follower.tick(now_us);
      if (!request) continue;
      ++requests;
      for (const StandInMapper& mapper : mappers) hear(mapper.answer(*request));
    }
  }
  std::int64_t version() const { return follower.held() ? follower.held()->version : -1; }
  std::int64_t counted(const std::string& name) {
    const auto message = health.due(now_us += 2 * kSecond_us);
    for (const counter_t& counter : message->counters)
      if (counter.name == name) return counter.count;
    return 0;
  }

  bus::Health health{"localiser"};
  MapFollower follower{health};
  std::vector<StandInMapper> mappers;
  std::map<std::int32_t, std::int64_t> blocks;
  std::int64_t now_us = 1'700'000'000 * kSecond_us;
  int requests = 0;
};

struct Follower : testing::Test, Line {
  Follower() {
    mappers.emplace_back(whole(kMine, 5));
    run(1.0);
    EXPECT_EQ(version(), 5);
    requests = 0;
  }
  // Still what it was, and without a doubt in the end.
  void expect_the_same() {
    run(1.0);
    EXPECT_EQ(follower.map_id(), kMine);
    EXPECT_EQ(version(), 5);
    EXPECT_EQ(blocks.size(), 10U);
    EXPECT_EQ(blocks[3], 5);
    requests = 0;
    run(2.0);
    EXPECT_EQ(requests, 0);
  }
};

TEST(MapFollower, AsksFourTimesASecondUntilTheMapperAnswersAndSaysSo) {
  Line line;
  line.run(3.0);
  EXPECT_NEAR(line.requests, 12, 1);
  EXPECT_FALSE(line.follower.map_id());
  line.run(1.0);
  EXPECT_THAT(line.health.message(), HasSubstr("mapper does not answer"));
  line.mappers.emplace_back(whole(kMine, 5));
  line.run(7.0);
  EXPECT_EQ(line.version(), 5);
  EXPECT_EQ(line.health.message(), "");
}

TEST(MapFollower, BelievesNobodyWhomItHasNotAsked) {
  Line line;
  line.hear(StandInMapper(whole(kOther, 0)).word());
  line.hear(bus::split_map(whole(kOther, 3)));
  EXPECT_FALSE(line.follower.held());
  line.mappers.emplace_back(whole(kMine, 0));
  line.run(0.1);
  EXPECT_EQ(line.follower.map_id(), kMine);
  EXPECT_EQ(line.version(), 0) << "the mapper said that its map is empty";
}

TEST_F(Follower, TakesWhatTheMapperAdds) {
  hear(bus::split_map(increment(kMine, 6)));
  EXPECT_EQ(version(), 6);
  EXPECT_EQ(blocks[0], 6);
  mappers[0].map() = whole(kMine, 6);
  hear(mappers[0].word());
  run(1.0);
  EXPECT_EQ(requests, 0);
}

TEST_F(Follower, AsksForWhatIsMissing) {
  mappers[0].map() = whole(kMine, 7);
  hear(bus::split_map(increment(kMine, 7)));
  EXPECT_EQ(version(), 5);
  run(0.1);
  EXPECT_EQ(version(), 7);
  EXPECT_EQ(requests, 1);
}

TEST_F(Follower, AsksAgainForAMapOfWhichAPartIsLost) {
  mappers.clear();
  follower.doubt();
  const auto request = follower.tick(now_us);
  ASSERT_TRUE(request);
  StandInMapper mapper(whole(kMine, 9));
  mapper.map().blocks.occupied.resize(1000, block(30, 9));
  auto answer = mapper.answer(*request);
  ASSERT_EQ(answer.size(), 3U);
  hear(answer[0]);
  hear(answer[2]);
  EXPECT_EQ(version(), 5);
  mappers.push_back(mapper);
  run(1.0);
  EXPECT_EQ(version(), 9);
}

TEST_F(Follower, GoesOverToAnotherMapWhenNobodyObjects) {
  mappers = {StandInMapper(whole(kOther, 0))};
  hear(mappers[0].word());
  run(0.2);
  EXPECT_EQ(follower.map_id(), kMine) << "the old mapper may still object";
  run(0.2);
  EXPECT_EQ(follower.map_id(), kOther);
  EXPECT_EQ(version(), 0);
  EXPECT_TRUE(blocks.empty());
  EXPECT_THAT(health.message(), HasSubstr("another map now"));
  EXPECT_EQ(counted("MAP_UPDATE/new_map"), 1);
}

TEST_F(Follower, StaysWhereTheOldMapperObjects) {
  for (const bool first : {false, true}) {
    const StandInMapper other(whole(kOther, 3));
    mappers.insert(first ? mappers.begin() : mappers.end(), other);
    hear(other.word());
    expect_the_same();
    EXPECT_THAT(health.message(), HasSubstr("two mappers answer"));
    mappers.resize(1, other);
    mappers[0].map() = whole(kMine, 5);
  }
}

TEST_F(Follower, LeavesOutAnOldRecording) {
  hear(StandInMapper(whole(kOther, 0)).word());
  for (std::int64_t v = 1; v < 20; ++v) {
    auto old = bus::split_map(increment(kOther, v));
    old.front().answers = now_us - 86'400 * kSecond_us;
    hear(old);
    run(0.1);
  }
  EXPECT_THAT(health.message(), HasSubstr("is a recording played"));
  EXPECT_EQ(health.state(), bus::Health::State::kWarning);
  expect_the_same();
}

TEST_F(Follower, LeavesOutAnOldRecordingOfTheSameMap) {
  hear(StandInMapper(whole(kMine, 0)).word());
  for (std::int64_t v = 1; v <= 5; ++v) hear(bus::split_map(increment(kMine, v)));
  hear(bus::split_map(whole(kMine, 3)));
  expect_the_same();
}

TEST_F(Follower, LeavesOutAForgedEmptyMap) {
  bus::MapChange empty = whole(kMine, 6);
  empty.blocks = {};
  for (const std::int64_t v : {5, 6, 1'000'000}) {
    empty.version = v;
    hear(bus::split_map(empty));
    EXPECT_EQ(blocks.size(), 10U);
  }
  hear(StandInMapper(whole(kMine, 0)).word());
  expect_the_same();
}

TEST_F(Follower, LeavesOutForgedMapsWhileItWaitsForTheRealOne) {
  mappers = {StandInMapper(whole(kOther, 30))};
  hear(mappers[0].word());
  while (follower.map_id() == kMine) {
    const auto request = follower.tick(now_us += kSecond_us / 50);
    if (request) hear(mappers[0].word(request->utime));
  }
  for (const std::int64_t version : {0, 25, 29, 31}) hear(bus::split_map(whole(kOther, version)));
  EXPECT_FALSE(follower.held());
  run(1.0);
  EXPECT_EQ(version(), 30);
}

// The second mapper's answer comes late, when another question has not been asked yet.
TEST_F(Follower, ALateAnswerOfAnotherMapperIsNoAnswer) {
  const StandInMapper other(whole(kOther, 3));
  follower.doubt();
  const auto request = follower.tick(now_us);
  ASSERT_TRUE(request);
  hear(mappers[0].answer(*request));
  hear(other.word());
  hear(other.word(request->utime));
  for (int i = 0; i < 20; ++i) follower.tick(now_us += kSecond_us / 50);
  EXPECT_EQ(follower.map_id(), kMine);
}

TEST_F(Follower, GoesBackWithTheMapperAlone) {
  mappers[0].map() = whole(kMine, 3);
  hear(mappers[0].word());
  EXPECT_EQ(version(), 5);
  run(0.1);
  EXPECT_EQ(version(), 3);
  EXPECT_EQ(blocks[3], 3);
}

// It cannot be told from a real one; but the mapper's next word does.
TEST_F(Follower, AForgedIncrementGoesWithTheMappersNextWord) {
  hear(bus::split_map(increment(kMine, 6)));
  EXPECT_EQ(blocks[0], 6);
  hear(mappers[0].word());
  expect_the_same();
  EXPECT_EQ(blocks[0], 5);
}

TEST_F(Follower, NamesWhatMakesNoSense) {
  auto absurd = bus::split_map(whole(kMine, 6));
  absurd[0].resolution_m = 1e-6;
  hear(absurd);
  EXPECT_THAT(health.message(), HasSubstr("voxels of a size that no map has"));
  expect_the_same();
  EXPECT_EQ(counted("MAP_UPDATE/bad_resolution"), 1);
}

// A listener with a bad line always ends with the mapper's map.
TEST(MapFollower, EndsWithTheMappersMapWhateverTheLineLoses) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const std::uint32_t loss_percent = seed % 2 ? 10 : 30;
    Line line;
    StandInMapper mapper(whole(kMine, 0));
    std::map<std::int32_t, std::int64_t> truth;
    const auto arrives = [&] { return random() % 100 >= loss_percent; };
    const auto say = [&](const std::vector<map_update_t>& messages) {
      for (const map_update_t& message : messages)
        if (arrives()) line.hear(message);
    };
    for (int cloud = 1; cloud < 300; ++cloud) {
      if (cloud < 250 && line.version() == mapper.map().version) {
        bus::MapChange next = increment(kMine, mapper.map().version + 1);
        for (std::int32_t i = 0; i < 1000; ++i) {
          next.blocks.occupied.push_back(
              block(static_cast<std::int32_t>(random() % 3000) + 1, cloud));
          truth[next.blocks.occupied.back().x] = cloud;
        }
        truth[0] = next.version;
        std::ranges::stable_sort(next.blocks.occupied, {}, &voxel_block_t::x);
        mapper.map() = next;
        mapper.map().base_version = bus::kWholeMap;
        mapper.map().blocks.occupied.clear();
        for (const auto& [x, bits] : truth) mapper.map().blocks.occupied.push_back(block(x, bits));
        say(bus::split_map(next));
      } else {
        say(mapper.word());
      }
      for (int i = 0; i < 10; ++i)
        if (const auto request = line.follower.tick(line.now_us += kSecond_us / 10);
            request && arrives())
          say(mapper.answer(*request));
    }
    EXPECT_GT(mapper.map().version, 20) << "seed " << seed;
    EXPECT_EQ(line.version(), mapper.map().version) << "seed " << seed;
    EXPECT_EQ(line.blocks, truth) << "seed " << seed;
  }
}

}  // namespace
}  // namespace voxlist::service
