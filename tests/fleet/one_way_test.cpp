#include "voxlist/fleet/one_way.h"

#include <gtest/gtest.h>

#include <utility>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

namespace voxlist::fleet {
namespace {

using Sent = std::vector<std::pair<std::string, std::uint8_t>>;  // channel, last byte

RelayChannel row(const std::string& name, Direction direction = Direction::kOut,
                 double max_hz = 1000.0) {
  RelayChannel made;
  made.name = name;
  made.direction = direction;
  made.max_hz = max_hz;
  return made;
}

template <class M>
std::vector<std::uint8_t> encoded() {
  std::vector<std::uint8_t> bytes;
  EXPECT_EQ(bus::encode(M{}, bytes), bus::Fault::kNone);
  return bytes;
}

class OneWayTest : public testing::Test {
 protected:
  OneWay::Send note() {
    return [this](const std::string& channel, bus::Bytes bytes) {
      sent_.emplace_back(channel, bytes.back());
    };
  }

  static void out(OneWay& way, const std::string& name, std::uint8_t byte, std::int64_t now_us) {
    const std::vector<std::uint8_t> bytes{byte};
    way.take("", name, "me/" + name, bytes, now_us);
  }

  Sent sent_;
};

TEST_F(OneWayTest, PassesWhatARowNamesAndNothingElse) {
  OneWay way({row("POSE"), row("GRID_*")}, Direction::kOut, note());
  for (const char* name : {"POSE", "POSE_COVARIANCE", "GRID_low", "CLOUD"}) out(way, name, 1, 0);
  EXPECT_EQ(sent_, (Sent{{"me/POSE", 1}, {"me/GRID_low", 1}}));
  EXPECT_EQ(way.counters().at("GRID_*/passed"), 1);
}

TEST_F(OneWayTest, LooksAtRowsOfItsDirectionAlone) {
  OneWay way({row("POSE", Direction::kIn)}, Direction::kOut, note());
  out(way, "POSE", 1, 0);
  EXPECT_TRUE(sent_.empty());
}

TEST_F(OneWayTest, TakesTheFirstRowThatMatches) {
  OneWay way({row("POSE", Direction::kOut, 1.0), row("P*")}, Direction::kOut, note());
  for (std::uint8_t i = 0; i < 5; ++i) out(way, "POSE", i, 0);
  EXPECT_EQ(sent_.size(), 1U);
}

TEST_F(OneWayTest, HoldsBackButAlwaysSendsTheLastWord) {
  OneWay way({row("GRID_*", Direction::kOut, 1.0)}, Direction::kOut, note());
  for (std::uint8_t i = 0; i < 10; ++i) out(way, "GRID_low", i, 0);
  EXPECT_EQ(sent_, (Sent{{"me/GRID_low", 0}}));
  way.tick(500'000);
  EXPECT_EQ(sent_.size(), 1U);
  way.tick(1'100'000);
  EXPECT_EQ(sent_.back(), (std::pair<std::string, std::uint8_t>("me/GRID_low", 9)));
  EXPECT_EQ(way.counters().at("GRID_*/held_back"), 8);
  EXPECT_EQ(way.counters().at("GRID_*/passed"), 2);
}

TEST_F(OneWayTest, LimitsEachChannelOfARowByItself) {
  OneWay way({row("GRID_*", Direction::kOut, 1.0)}, Direction::kOut, note());
  out(way, "GRID_low", 1, 0);
  out(way, "GRID_high", 2, 0);
  EXPECT_EQ(sent_.size(), 2U);
}

TEST_F(OneWayTest, PassesNoRawCloudWhateverItsChannelIsCalled) {
  OneWay way({row("*")}, Direction::kOut, note());
  way.take("", "POSE", "me/POSE", encoded<pointcloud_t>(), 0);
  EXPECT_TRUE(sent_.empty());
  EXPECT_EQ(way.counters().at("*/raw_cloud"), 1);
  way.take("", "CLOUD", "me/CLOUD", encoded<pose_t>(), 0);
  EXPECT_EQ(sent_.size(), 1U);
}

TEST_F(OneWayTest, PassesRawCloudsWhereTheRowSaysSo) {
  RelayChannel clouds = row("CLOUD");
  clouds.clouds = true;
  OneWay way({clouds}, Direction::kOut, note());
  way.take("", "CLOUD", "me/CLOUD", encoded<pointcloud_t>(), 0);
  EXPECT_EQ(sent_.size(), 1U);
}

TEST_F(OneWayTest, TakesTheRobotsThatARowNames) {
  RelayChannel one = row("POSE", Direction::kIn);
  one.robot = "b*";
  OneWay way({one}, Direction::kIn, note());
  const std::vector<std::uint8_t> bytes{1};
  for (const std::string robot : {"a", "b", "b2"})
    way.take(robot, "POSE", robot + "/POSE", bytes, 0);
  EXPECT_EQ(sent_, (Sent{{"b/POSE", 1}, {"b2/POSE", 1}}));
}

TEST_F(OneWayTest, BoundsWhatManyNamesCost) {
  OneWay way({row("*")}, Direction::kOut, note());
  for (std::size_t i = 0; i < OneWay::kMostChannels + 5; ++i) out(way, std::to_string(i), 1, 0);
  EXPECT_EQ(sent_.size(), OneWay::kMostChannels);
  EXPECT_EQ(way.counters().at("too_many_channels"), 5);
}

TEST_F(OneWayTest, LeavesOutWhatComesInAgain) {
  OneWay way({row("POSE", Direction::kIn)}, Direction::kIn, note());
  const std::vector<std::uint8_t> one{1}, two{2};
  way.take("b", "POSE", "b/POSE", one, 0);
  way.take("b", "POSE", "b/POSE", two, 1000);
  way.take("b", "POSE", "b/POSE", one, 2000);
  way.take("c", "POSE", "c/POSE", one, 2000);
  EXPECT_EQ(sent_, (Sent{{"b/POSE", 1}, {"b/POSE", 2}, {"c/POSE", 1}}));
  EXPECT_EQ(way.counters().at("POSE/repeated"), 1);
  way.take("b", "POSE", "b/POSE", one, 4'000'000);
  EXPECT_EQ(sent_.size(), 4U) << "seconds later it is said again on purpose";
}

TEST_F(OneWayTest, LetsARobotsOwnWordsGoOutAgain) {
  OneWay way({row("GRID_low")}, Direction::kOut, note());
  out(way, "GRID_low", 1, 0);
  out(way, "GRID_low", 1, 1000);
  EXPECT_EQ(sent_.size(), 2U);
}

TEST_F(OneWayTest, GivesUpChannelsThatAreSilent) {
  OneWay way({row("*")}, Direction::kOut, note());
  for (std::size_t i = 0; i < OneWay::kMostChannels; ++i) out(way, std::to_string(i), 1, 0);
  out(way, "LATE", 1, OneWay::kSilent_us);
  EXPECT_EQ(sent_.size(), OneWay::kMostChannels);
  out(way, "LATE", 1, OneWay::kSilent_us + 1);
  EXPECT_EQ(sent_.size(), OneWay::kMostChannels + 1);
}

TEST_F(OneWayTest, LetsOnlySoMuchWait) {
  RelayChannel slow = row("*", Direction::kOut, 0.01);
  slow.max_kBps = 100'000.0;
  OneWay way({slow}, Direction::kOut, note());
  const std::vector<std::uint8_t> large(30'000'000, 1);
  for (const std::string name : {"A", "B", "C", "D", "E"})
    for (int i = 0; i < 3; ++i) way.take("", name, "me/" + name, large, 0);
  EXPECT_EQ(sent_.size(), 5U) << "the first of each";
  EXPECT_EQ(way.counters().at("*/too_much_waiting"), 4) << "of D and E both";
  way.tick(101'000'000);
  EXPECT_EQ(sent_.size(), 8U);
}

}  // namespace
}  // namespace voxlist::fleet
