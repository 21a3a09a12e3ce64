// The followers of tests/clients, in C++ and in Python, read the same recording of POSE and
// OBSTACLES; what they would have done is written here.
#include <gmock/gmock.h>

#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pose_t.hpp>

#include "tests/temporary_folder.h"
#include "voxlist/bus/channels.h"
#include "voxlist/bus/event_log.h"

namespace voxlist {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::StartsWith;

constexpr std::int64_t kStart_us = 1'700'000'000'000'000, kPeriod_us = 66'667;
constexpr int kBearings = 72;

// All is free and seen up to 10 m.
obstacles_t clear() {
  obstacles_t message{};
  message.n_bearings = kBearings;
  message.radstep = 2.F * 3.14159265F / kBearings;
  const std::vector<float> none(kBearings, std::numeric_limits<float>::infinity());
  message.nearest_m.assign(3, none);
  message.ground_seen_to_m.assign(kBearings, 10.F);
  return message;
}

// A robot that stands at the map's origin, and looks along x.
class Recording {
 public:
  // One turn of the detector, and one POSE after it.
  void add(obstacles_t obstacles) {
    obstacles.utime = now_us_;
    log_->write(bus::kObstacles, now_us_, obstacles);
    add_pose();
  }

  void add_pose() {
    pose_t pose{};
    pose.utime = now_us_ + 1000;
    pose.orientation[0] = 1.0;
    log_->write(bus::kPose, pose.utime, pose);
    now_us_ += kPeriod_us;
  }

  void wait(int periods) { now_us_ += periods * kPeriod_us; }

  // What both say of it.
  std::vector<std::string> commands(const std::string& way) {
    log_->close();
    const std::string log = (folder_ / "run.lcm").string();
    const auto lines = lines_of("LCM_DEFAULT_URL='file://" + log +
                                "?speed=0' '" VOXLIST_BIN_DIR "/follower' " + way);
    EXPECT_EQ(lines, lines_of("PYTHONDONTWRITEBYTECODE=1 PYTHONPATH='" VOXLIST_BIN_DIR
                              "/../lcmtypes/python' python3 '" VOXLIST_SOURCE_DIR
                              "/tests/clients/follower.py' '" +
                              log + "' " + way));
    return lines;
  }

 private:
  static std::vector<std::string> lines_of(const std::string& command) {
    const std::unique_ptr<FILE, int (*)(FILE*)> out(popen(command.c_str(), "r"), pclose);
    std::vector<std::string> lines;
    for (char line[200]; std::fgets(line, sizeof line, out.get());) {
      lines.emplace_back(line);
      lines.back().pop_back();
    }
    return lines;
  }

  const test::TemporaryFolder folder_;
  std::unique_ptr<bus::EventLogWriter> log_ =
      std::make_unique<bus::EventLogWriter>((folder_ / "run.lcm").string());
  std::int64_t now_us_ = kStart_us;
};

std::vector<std::string> commands_to(const obstacles_t& obstacles, const std::string& way = "5 0") {
  Recording recording;
  recording.add(obstacles);
  return recording.commands(way);
}

TEST(Follower, DrivesWhereTheFloorWasSeenAndNothingStands) {
  EXPECT_THAT(commands_to(clear()), ElementsAre("drive 0.89 m/s, turn 0.00 rad/s"));
}

TEST(Follower, TurnsTowardsItsWayWhereItStands) {
  EXPECT_THAT(commands_to(clear(), "0 5"), ElementsAre("drive 0.00 m/s, turn 1.00 rad/s"));
}

TEST(Follower, StandsWhereItsWayEnds) {
  EXPECT_THAT(commands_to(clear(), "0.1 0.1"), ElementsAre("stop: it is there"));
}

TEST(Follower, StopsBeforeWhateverStandsHangsOrGapes) {
  for (const std::size_t type : {0U, 1U, 2U}) {
    obstacles_t near = clear(), farther = clear(), beside = clear();
    near.nearest_m[type][0] = 0.33F;
    farther.nearest_m[type][0] = 0.9F;
    beside.nearest_m[type][kBearings / 4] = 0.33F;
    EXPECT_THAT(commands_to(near), ElementsAre("stop: the way is not free")) << type;
    EXPECT_THAT(commands_to(farther), ElementsAre("drive 0.83 m/s, turn 0.00 rad/s"));
    EXPECT_THAT(commands_to(beside), ElementsAre("drive 0.89 m/s, turn 0.00 rad/s"));
  }
}

TEST(Follower, GoesNoFartherThanTheFloorWasSeen) {
  obstacles_t unseen = clear();
  unseen.ground_seen_to_m.assign(kBearings, 0.29F);
  EXPECT_THAT(commands_to(unseen), ElementsAre("stop: the way is not free"));
}

TEST(Follower, TurnsOnTheSpotWhereItMayNotDrive) {
  obstacles_t unseen = clear();
  unseen.ground_seen_to_m.assign(kBearings, 0.F);
  EXPECT_THAT(commands_to(unseen, "0 5"), ElementsAre("drive 0.00 m/s, turn 1.00 rad/s"));
}

TEST(Follower, WaitsForOneWhoStandsBesideItsWayAndMayGoOn) {
  obstacles_t beside = clear();
  beside.n_moving = 1;
  beside.moving.resize(1);
  beside.moving[0] = {{1.F, 1.F}, {0.F, 0.F}, 0.25F};
  EXPECT_THAT(commands_to(beside), ElementsAre("drive 0.39 m/s, turn 0.00 rad/s"));
}

TEST(Follower, StopsForOneWhoIsAboutToStepBeforeIt) {
  obstacles_t crossed = clear();
  crossed.n_moving = 1;
  crossed.moving.resize(1);
  crossed.moving[0] = {{0.5F, 0.7F}, {0.F, -1.2F}, 0.25F};
  EXPECT_THAT(commands_to(crossed), ElementsAre("stop: the way is not free"));
}

TEST(Follower, StopsWhenNothingIsSeen) {
  obstacles_t blind = clear();
  blind.blind = "no slices";
  EXPECT_THAT(commands_to(blind), ElementsAre("stop: blind: no slices"));
  obstacles_t empty{};
  empty.nearest_m.resize(3);
  EXPECT_THAT(commands_to(empty), ElementsAre("stop: nothing was seen"));
}

TEST(Follower, StopsWhenObstaclesStop) {
  Recording recording;
  recording.add(clear());
  for (int i = 0; i < 8; ++i) recording.add_pose();
  const auto commands = recording.commands("5 0");
  ASSERT_EQ(commands.size(), 9U);
  EXPECT_THAT((std::vector(commands.begin(), commands.begin() + 4)), Each(StartsWith("drive")));
  EXPECT_THAT((std::vector(commands.begin() + 5, commands.end())), Each("stop: OBSTACLES are old"));
}

}  // namespace
}  // namespace voxlist
