// A recording as a page: what is marked in it, and that any time of it can be shown.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <voxlist/health_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/voxlist/view/highlights.h"
#include "services/voxlist/view/player.h"
#include "services/voxlist/view/replay.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::desk {
namespace {

constexpr std::int64_t kSecond_us = 1'000'000, kBegin_us = 1'000 * kSecond_us;

localisation_t localisation(std::int32_t state, std::int64_t utime_us) {
  localisation_t message{};
  message.utime = utime_us;
  message.state = state;
  return message;
}

bus::MapChange map_of(std::int32_t voxels, std::int64_t version, std::int64_t moves) {
  OccupancyMap map{VoxelMap(0.05), VoxelMap(0.1)};
  for (std::int32_t i = 0; i < voxels; ++i) map.occupied.insert({8 * i, 0, 0});
  bus::MapChange change;
  change.utime_us = kBegin_us;
  change.map_id = 5;
  change.version = version;
  change.base_version = version == 1 ? bus::kWholeMap : version - 1;
  change.resolution = bus::resolution_of(map);
  change.blocks = bus::to_messages(map);
  change.moves = moves;
  return change;
}

// Ten seconds: LOST from the third to the fifth, a loop at the sixth, a warning at the seventh; a
// cloud each second, and a map that grows.
std::string write_recording(const std::filesystem::path& folder, const std::string& prefix = {}) {
  const std::string path = folder / "run.lcm";
  bus::EventLogWriter log(path, prefix);
  for (int s = 0; s < 10; ++s) {
    const std::int64_t utime_us = kBegin_us + s * kSecond_us;
    const bool is_lost = s >= 3 && s < 5;
    pointcloud_t cloud{};
    cloud.utime = utime_us;
    log.write(bus::kCloud, utime_us, cloud);
    localisation_t found = localisation(localisation_t::STATE_TRACKING, utime_us);
    if (is_lost) found.state = localisation_t::STATE_LOST;
    found.n_modes = 1;
    found.modes.resize(1);
    log.write(bus::kLocalisation, utime_us, found);
    for (const auto& message : bus::split_map(map_of(s + 1, s + 1, s >= 6 ? 1 : 0)))
      log.write(bus::kMapUpdate, utime_us, message);
    health_t health{};
    health.service = "mapper";
    if (s == 7) health.state = health_t::STATE_WARNING;
    log.write(bus::kHealth, utime_us, health);
    pose_t pose{};
    pose.utime = utime_us;
    pose.pos[0] = s;
    pose.orientation[0] = 1.0;
    log.write(bus::kPose, utime_us, pose);
  }
  log.close();
  return path;
}

viewing::Viewer viewer() { return viewing::Viewer(viewing::ViewerConfig{}); }

// What a page that opens now is told, but not in which order and how old it is.
std::map<std::string, std::string> shown(viewing::Viewer& viewer) {
  std::map<std::string, std::string> topics;
  const viewing::Board& board = viewer.scene().board();
  for (auto entry = board.next_after(0); entry.topic; entry = board.next_after(entry.number))
    if (!entry.topic->name.starts_with("path") && entry.topic->name != "rewound")
      topics[entry.topic->name] = entry.topic->json;
  return topics;
}

void go_to(Replay& replay, int second) {
  while (!replay.advance(kBegin_us + second * kSecond_us, 7)) {
  }
}

TEST(Highlights, SayWhenTheRobotWasLostWhenLoopsWereClosedAndWhatWarned) {
  test::TemporaryFolder folder;
  LogEvents events(write_recording(folder.path()), "");
  const Highlights found = highlights_of(events);
  EXPECT_EQ(found.begin_us, kBegin_us);
  EXPECT_EQ(found.end_us, kBegin_us + 9 * kSecond_us);
  ASSERT_EQ(found.lost.size(), 1U);
  EXPECT_EQ(found.lost[0].from_us, kBegin_us + 3 * kSecond_us);
  EXPECT_EQ(found.lost[0].to_us, kBegin_us + 5 * kSecond_us);
  EXPECT_THAT(found.loops, testing::ElementsAre(kBegin_us + 6 * kSecond_us));
  EXPECT_THAT(found.warnings, testing::ElementsAre(kBegin_us + 7 * kSecond_us));
  EXPECT_TRUE(found.has_map);
  EXPECT_TRUE(events.next().has_value());
}

TEST(LogEvents, AreThoseOfOneRobot) {
  test::TemporaryFolder folder;
  const std::string path = write_recording(folder.path(), "robot_1/");
  LogEvents own(path, "robot_1/"), others(path, "robot_2/");
  EXPECT_EQ(own.next().value().channel, "CLOUD");
  EXPECT_FALSE(others.next().has_value());
}

TEST(Replay, ShowsWhatWasAtThatTime) {
  test::TemporaryFolder folder;
  viewing::Viewer seen = viewer();
  Replay replay(std::make_unique<LogEvents>(write_recording(folder.path()), ""), seen, {});
  go_to(replay, 4);
  EXPECT_THAT(shown(seen)["robot"], testing::HasSubstr("LOST"));
  EXPECT_THAT(shown(seen)["map"], testing::HasSubstr("\"version\":5,"));
  go_to(replay, 8);
  EXPECT_THAT(shown(seen)["robot"], testing::HasSubstr("TRACKING"));
  EXPECT_THAT(shown(seen)["map"], testing::HasSubstr("\"version\":9,"));
}

TEST(Replay, ShowsTheSameBackwardsAsForwards) {
  test::TemporaryFolder folder;
  const std::string path = write_recording(folder.path());
  viewing::Viewer forwards = viewer(), backwards = viewer();
  Replay straight(std::make_unique<LogEvents>(path, ""), forwards, {});
  go_to(straight, 5);
  Replay turned(std::make_unique<LogEvents>(path, ""), backwards, {});
  go_to(turned, 9);
  turned.rewind();
  go_to(turned, 5);
  auto expected = shown(forwards), got = shown(backwards);
  ASSERT_GE(expected.size(), 4U);
  EXPECT_EQ(expected["robot"], got["robot"]);
  EXPECT_EQ(expected["pose"], got["pose"]);
  EXPECT_EQ(expected["service/mapper"], got["service/mapper"]);
  EXPECT_EQ(forwards.levels().map().hash(), backwards.levels().map().hash());
}

struct Played {
  explicit Played(const std::filesystem::path& folder)
      : path(write_recording(folder)),
        player(std::make_unique<LogEvents>(path, ""), found(), "run.lcm", {}, {}, {}) {}

  Highlights found() const {
    LogEvents events(path, "");
    return highlights_of(events);
  }

  void run(double seconds) {
    for (double s = 0.0; s < seconds; s += 0.02) player.tick(now_us += 20'000);
  }

  double shown_s() const { return 1e-6 * static_cast<double>(player.shown_us() - kBegin_us); }

  std::string path;
  Player player;
  std::int64_t now_us = 77 * kSecond_us;
};

TEST(Player, PlaysAtItsSpeedAndStopsAtTheEnd) {
  test::TemporaryFolder folder;
  Played played(folder.path());
  played.run(2.0);
  EXPECT_NEAR(played.shown_s(), 2.0, 0.1);
  EXPECT_EQ(played.player.obey("play", R"({"speed":4})").status, 204U);
  played.run(1.0);
  EXPECT_NEAR(played.shown_s(), 6.0, 0.2);
  EXPECT_EQ(played.player.obey("play", R"({"speed":0})").status, 204U);
  played.run(1.0);
  EXPECT_NEAR(played.shown_s(), 6.0, 0.2);
  EXPECT_EQ(played.player.obey("play", R"({"speed":16})").status, 204U);
  played.run(2.0);
  EXPECT_DOUBLE_EQ(played.shown_s(), 9.0);
}

TEST(Player, GoesToATimeAndNoFartherThanThereIs) {
  test::TemporaryFolder folder;
  Played played(folder.path());
  played.player.obey("play", R"({"speed":0})");
  const auto seek = [&](double s) {
    const auto utime_us = kBegin_us + static_cast<std::int64_t>(1e6 * s);
    return played.player.obey("seek", "{\"utime_us\":" + std::to_string(utime_us) + "}").status;
  };
  for (const auto& [to_s, shown_s] : {std::pair{7.0, 7.0}, {2.5, 2.5}, {-5.0, 0.0}, {99.0, 9.0}}) {
    EXPECT_EQ(seek(to_s), 204U);
    played.run(0.2);
    EXPECT_NEAR(played.shown_s(), shown_s, 0.001);
  }
}

TEST(Player, TakesNoOrders) {
  test::TemporaryFolder folder;
  Played played(folder.path());
  EXPECT_EQ(played.player.obey("save", "{}").status, 409U);
  EXPECT_EQ(played.player.obey("nothing", "{}").status, 400U);
}

TEST(MapEvents, TellTheMapAndWhereTheRobotWas) {
  OccupancyMap map;
  map.occupied.insert({1, 2, 3});
  StampedPose3 first{kBegin_us, Pose3::Identity()}, last{kBegin_us + kSecond_us, Pose3::Identity()};
  last.pose.translation().x() = 4.0;
  viewing::Viewer seen = viewer();
  Replay replay(std::make_unique<MapEvents>(map, map, std::vector{first, last}), seen, {});
  go_to(replay, 1);
  EXPECT_EQ(seen.levels().map().size(), 1U);
  EXPECT_THAT(shown(seen)["pose"], testing::HasSubstr("4.0"));
  EXPECT_THAT(shown(seen)["robot"], testing::HasSubstr("TRACKING"));
}

}  // namespace
}  // namespace voxlist::desk
