#include "voxlist/viewing/client.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/viewing/blocks/map_change.h"
#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::viewing {
namespace {

nlohmann::json json_in(const Frame& frame) {
  const std::size_t length = frame[0] + 256U * frame[1];
  return nlohmann::json::parse(frame.begin() + 4,
                               frame.begin() + 4 + static_cast<std::ptrdiff_t>(length));
}

struct Shown {
  Shown() { show(whole_map({{0, 0, 0}, {100, 0, 0}})); }

  void show(const bus::MapChange& change) {
    levels.apply(change);
    levels.refresh(1'000'000);
    for (const auto& changed : levels.take_changed()) client.add(changed);
  }

  // Topics of the frames that the client gets; blocks with their level.
  std::vector<std::string> all() {
    std::vector<std::string> topics;
    while (const auto frame = client.next({board, levels, space}, 3'000'000)) {
      const auto json = json_in(*frame);
      std::string topic = json.at("topic");
      if (topic == "blocks" || topic == "space") topic += json.at("data").at("level").dump();
      topics.push_back(topic);
      bytes += frame->size();
    }
    return topics;
  }

  Board board;
  MapLevels levels{0.05};
  SpaceLevels space;
  Client client;
  std::size_t bytes = 0;
};

using Topics = std::vector<std::string>;

bus::MapChange free_space() {
  OccupancyMap cells{VoxelMap(0.08), VoxelMap(0.08)};
  cells.passed.insert({1, 1, 1});
  cells.occupied.insert({1, 1, 2});
  bus::MapChange change;
  change.map_id = change.version = 1;
  change.resolution = bus::resolution_of(cells);
  change.blocks = bus::to_messages(cells);
  return change;
}

TEST(Client, GetsFreeAndOccupiedSpaceOnlyWhileItWantsThem) {
  Shown shown;
  shown.space.apply(free_space());
  EXPECT_EQ(shown.all(), (Topics{"blocks1", "blocks0"}));
  shown.client.want_space(true);
  EXPECT_EQ(shown.all(), (Topics{"space0", "space1"}));
  EXPECT_EQ(shown.all(), Topics{});
  shown.client.want_space(false);
  shown.client.add_space({kFreeCells, 0});
  EXPECT_EQ(shown.all(), Topics{});
  shown.client.want_space(true);
  EXPECT_EQ(shown.all(), (Topics{"space0", "space1"}));
}

TEST(Client, GetsTheBoardThenCoarseThenFineBlocks) {
  Shown shown;
  shown.board.put("robot", "{}", 1'000'000);
  EXPECT_EQ(shown.all(), (Topics{"robot", "blocks1", "blocks0"}));
  EXPECT_EQ(shown.all(), Topics{});
}

TEST(Client, GetsWhatChangedWhileItWasSlowOnceAndAsItIsNow) {
  Shown shown;
  shown.all();
  const std::size_t before = shown.bytes;
  for (int i = 1; i < 50; ++i) {
    shown.board.put("robot", "{\"i\":" + std::to_string(i) + "}", 0);
    shown.show(changed_map({{i % 8, 0, 0}}, i + 1));
  }
  EXPECT_EQ(shown.all(), (Topics{"robot", "blocks1", "blocks0"}));
  EXPECT_LT(shown.bytes - before, 700U);
}

TEST(Client, IsToldHowOldATopicIs) {
  Shown shown;
  shown.board.put("robot", "{}", 1'000'000);
  const auto frame = shown.client.next({shown.board, shown.levels, shown.space}, 3'500'000);
  ASSERT_TRUE(frame);
  EXPECT_EQ(json_in(*frame).at("age_ms"), 2500);
}

TEST(Client, GetsBlocksBetweenLargeTopics) {
  Shown shown;
  shown.board.put("cloud", "{}", 0, std::vector<std::uint8_t>(20'000));
  shown.board.put("robot", "{}", 0);
  EXPECT_EQ(shown.all(), (Topics{"cloud", "blocks1", "robot", "blocks0"}));
}

TEST(Client, GetsAllOfAnotherMap) {
  Shown shown;
  shown.all();
  shown.show(whole_map({{0, 0, 0}}, 2));
  EXPECT_EQ(shown.all(), (Topics{"blocks1", "blocks0"}));
}

}  // namespace
}  // namespace voxlist::viewing
