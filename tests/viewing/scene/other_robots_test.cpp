#include "voxlist/viewing/scene/other_robots.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <voxlist/localisation_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/viewing/scene/board.h"

namespace voxlist::viewing {
namespace {

using bus::Fault;
using nlohmann::json;

constexpr std::int64_t kOurMap = 11, kTheirMap = 22;

template <class M>
std::vector<std::uint8_t> encoded(const M& message) {
  std::vector<std::uint8_t> bytes;
  EXPECT_EQ(bus::encode(message, bytes), Fault::kNone);
  return bytes;
}

std::vector<std::uint8_t> pose_at(double x_m, double y_m) {
  pose_t message{};
  message.utime = 5'000'000;
  message.pos[0] = x_m;
  message.pos[1] = y_m;
  message.orientation[0] = 1.0;
  return encoded(message);
}

std::vector<std::uint8_t> tracking_in(std::int64_t map_id) {
  localisation_t message{};
  message.state = localisation_t::STATE_TRACKING;
  message.map_id = map_id;
  return encoded(message);
}

class OtherRobotsTest : public testing::Test {
 protected:
  Fault take(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
    return robots_.take(channel, bytes, kOurMap, 7'000'000, board_);
  }

  json data(const std::string& topic) const {
    for (auto entry = board_.next_after(0); entry.topic; entry = board_.next_after(entry.number))
      if (entry.topic->name == topic) return json::parse(entry.topic->json);
    return {};
  }

  std::size_t topics() const {
    std::size_t count = 0;
    for (auto entry = board_.next_after(0); entry.topic; entry = board_.next_after(entry.number))
      ++count;
    return count;
  }

  OtherRobots robots_{{{.name = "c", .x_m = 10.0, .y_m = 1.0, .yaw_deg = 90.0}}};
  Board board_;
};

TEST_F(OtherRobotsTest, PlacesARobotThatHasTheSameMap) {
  take("b/LOCALISATION", tracking_in(kOurMap));
  EXPECT_EQ(take("b/POSE", pose_at(2.0, 3.0)), Fault::kNone);
  const json other = data("other/b");
  EXPECT_EQ(other["state"], "TRACKING");
  EXPECT_EQ(other["utime_us"], 5'000'000) << "the other robot's time";
  EXPECT_EQ(other["pose"], json::parse("[2.0, 3.0, 0.0, 0.0]"));
}

TEST_F(OtherRobotsTest, OnlyTellsOfOneInAMapOfItsOwn) {
  take("b/LOCALISATION", tracking_in(kTheirMap));
  take("b/POSE", pose_at(2.0, 3.0));
  EXPECT_TRUE(data("other/b")["pose"].is_null());
  EXPECT_EQ(data("service/robot b")["message"], "TRACKING at 2.0, 3.0 m in a map of its own");
  take("d/POSE", pose_at(2.0, 3.0));
  EXPECT_EQ(data("other/d")["state"], "unknown") << "it has not said";
  EXPECT_TRUE(data("other/d")["pose"].is_null());
}

TEST_F(OtherRobotsTest, PlacesOneWhoseMapTheSettingsPlace) {
  take("c/LOCALISATION", tracking_in(kTheirMap));
  take("c/POSE", pose_at(2.0, 3.0));
  const json other = data("other/c");
  EXPECT_NEAR(other["pose"][0], 7.0, 1e-3);
  EXPECT_NEAR(other["pose"][1], 3.0, 1e-3);
  EXPECT_NEAR(other["pose"][3], std::numbers::pi / 2.0, 1e-4);
}

TEST_F(OtherRobotsTest, LeavesOutWhatIsNoMessageAndNamesThatAreNone) {
  EXPECT_EQ(take("b/POSE", {1, 2, 3}), Fault::kTruncated);
  EXPECT_EQ(take("b/POSE", tracking_in(kOurMap)), Fault::kWrongType);
  EXPECT_EQ(take("b/LOCALISATION", pose_at(0.0, 0.0)), Fault::kWrongType);
  EXPECT_NE(take("b/POSE", pose_at(std::nan(""), 0.0)), Fault::kNone);
  for (const std::string name : {"", "a\"b", "<b>", "a b"})
    EXPECT_EQ(take(name + "/POSE", pose_at(0.0, 0.0)), Fault::kBadText) << name;
  EXPECT_EQ(take(std::string(41, 'a') + "/POSE", pose_at(0.0, 0.0)), Fault::kBadText);
  EXPECT_EQ(topics(), 0U);
}

TEST_F(OtherRobotsTest, KeepsSoManyAtMost) {
  for (std::size_t i = 0; i < 2 * OtherRobots::kMostRobots; ++i)
    take("robot_" + std::to_string(i) + "/POSE", pose_at(0.0, 0.0));
  EXPECT_EQ(topics(), 2 * OtherRobots::kMostRobots);
}

}  // namespace
}  // namespace voxlist::viewing
