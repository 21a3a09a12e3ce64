#include "voxlist/viewing/scene/robot_scene.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>
#include <voxlist/health_t.hpp>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

namespace voxlist::viewing {
namespace {

using nlohmann::json;

const Topic* find(const RobotScene& scene, const std::string& name) {
  const Board& board = scene.board();
  for (auto entry = board.next_after(0); entry.topic; entry = board.next_after(entry.number))
    if (entry.topic->name == name) return entry.topic;
  return nullptr;
}

json data(const RobotScene& scene, const std::string& name) {
  const Topic* topic = find(scene, name);
  return topic ? json::parse(topic->json) : json();
}

localisation_t localisation(std::int32_t state, std::int64_t utime_us) {
  localisation_t message{};
  message.utime = utime_us;
  message.map_version = 1;
  message.state = state;
  message.confidence = 0.5;
  message.modes.resize(1);
  message.modes[0].pose[0] = 2.0;
  message.modes[0].pose[2] = 1.0;
  message.modes[0].probability = 0.1;
  message.n_modes = 1;
  return message;
}

pointcloud_t cloud(std::int64_t utime_us) {
  pointcloud_t message{};
  message.utime = utime_us;
  message.points = {{1.0F, 2.0F, -0.5F}, {std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F}};
  message.n_points = 2;
  return message;
}

pose_t pose(double x_m, std::int64_t utime_us) {
  pose_t message{};
  message.utime = utime_us;
  message.pos[0] = x_m;
  message.orientation[0] = 1.0;
  return message;
}

TEST(RobotScene, TellsHowLongAStateLasts) {
  RobotScene scene(100);
  scene.take(localisation(localisation_t::STATE_TRACKING, 1'000'000), 0);
  scene.take(localisation(localisation_t::STATE_LOST, 2'000'000), 0);
  scene.take(localisation(localisation_t::STATE_LOST, 5'500'000), 0);
  EXPECT_EQ(data(scene, "robot").at("state"), "LOST");
  EXPECT_DOUBLE_EQ(data(scene, "robot").at("for_s"), 3.5);
}

TEST(RobotScene, TellsWhyTheRobotIsLost) {
  RobotScene scene(100);
  localisation_t lost = localisation(localisation_t::STATE_LOST, 1);
  scene.take(lost, 0);
  EXPECT_EQ(data(scene, "robot").at("why"),
            "the map may not know this place: all candidates together have 10 %");
  lost.modes.clear();
  scene.take(lost, 0);
  EXPECT_EQ(data(scene, "robot").at("why"), "nothing in the map fits what the robot sees");
  lost.map_version = 0;
  scene.take(lost, 0);
  EXPECT_EQ(data(scene, "robot").at("why"), "there is no map yet");
}

TEST(RobotScene, PlacesACloudWhereItsLocalisationSays) {
  RobotScene scene(100);
  scene.take_cloud(cloud(7), 0);
  EXPECT_EQ(find(scene, "cloud"), nullptr);
  scene.take(localisation(localisation_t::STATE_TRACKING, 6), 0);
  EXPECT_EQ(find(scene, "cloud"), nullptr);
  scene.take(localisation(localisation_t::STATE_TRACKING, 7), 0);
  EXPECT_EQ(data(scene, "cloud").at("pose"), json({2.0, 0.0, 0.0, 1.0}));
  const std::vector<std::uint8_t> centimetres{100, 0, 200, 0, 206, 255};
  EXPECT_EQ(find(scene, "cloud")->bytes, centimetres);
}

TEST(RobotScene, PlacesNoCloudOfALostRobot) {
  RobotScene scene(100);
  scene.take_cloud(cloud(7), 0);
  scene.take(localisation(localisation_t::STATE_LOST, 7), 0);
  EXPECT_EQ(find(scene, "cloud"), nullptr);
}

TEST(RobotScene, PlacesASliceAtAPoseOfItsTimeOnly) {
  RobotScene scene(100);
  scene.take(pose(3.0, 1'000'000), 0);
  scene.take_slice(cloud(2'000'000), 0);
  EXPECT_EQ(find(scene, "slice/0"), nullptr);
  scene.take_slice(cloud(1'100'000), 0);
  EXPECT_EQ(data(scene, "slice/0").at("pose").at(0), 3.0);
}

std::vector<float> path_of(const RobotScene& scene, const std::string& topic) {
  const auto& bytes = find(scene, topic)->bytes;
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

TEST(RobotScene, KeepsThePathInPiecesOfWhichOneGrows) {
  RobotScene scene(100);
  // The robot goes to and fro, farther each time, so that each point is needed.
  for (int i = 0; i < 100; ++i) scene.take(pose(i % 2 == 0 ? 0.2 * i : -0.2 * i, i + 1), 0);
  EXPECT_EQ(find(scene, "path/0")->bytes.size(), 64U * 16);
  EXPECT_EQ(find(scene, "path/1")->bytes.size(), (100U - 64 + 1) * 16);
}

TEST(RobotScene, KeepsTheBendsOfALongPath) {
  RobotScene scene(100);
  // The robot drives to x = 6.2 m and back to 3 m, and jumps to x = 1009.6 m.
  for (int i = 0; i < 32; ++i) scene.take(pose(0.2 * i, i + 1), 0);
  for (int i = 32; i < 48; ++i) scene.take(pose(0.2 * (62 - i), i + 1), 0);
  for (int i = 48; i < 65; ++i) scene.take(pose(1000.0 + 0.2 * i, i + 1), 0);
  const std::vector<float> path = path_of(scene, "path/0");
  std::vector<std::pair<float, bool>> x_and_begins;
  for (std::size_t i = 0; i < path.size(); i += 4)
    x_and_begins.push_back({path[i], path[i + 3] != 0.0F});
  EXPECT_EQ(x_and_begins, (std::vector<std::pair<float, bool>>{{0.0F, true},
                                                               {6.2F, false},
                                                               {3.0F, false},
                                                               {1009.6F, true},
                                                               {1012.6F, false},
                                                               {1012.8F, false}}));
}

TEST(RobotScene, TellsALongStraightPathInFewPoints) {
  RobotScene scene(100);
  for (int i = 0; i < 1000; ++i) scene.take(pose(0.2 * i, i + 1), 0);
  EXPECT_LE(find(scene, "path/0")->bytes.size(), 64U * 16);
  EXPECT_EQ(find(scene, "path/1"), nullptr);
}

TEST(RobotScene, AddsNothingToThePathOfARobotThatStands) {
  RobotScene scene(100);
  for (int i = 0; i < 100; ++i) scene.take(pose(0.0001 * i, i + 1), 0);
  EXPECT_EQ(find(scene, "path/0")->bytes.size(), 16U);
}

bus::MapChange map_of(std::int64_t keyframes, std::int64_t moves) {
  bus::MapChange change;
  change.map_id = 7;
  change.version = keyframes + moves;
  change.moves = moves;
  return change;
}

keyframe_t keyframe(std::int32_t index, double x_m, double y_m) {
  keyframe_t message{};
  message.utime = 1;
  message.map_id = 7;
  message.index = index;
  message.trans[0] = x_m;
  message.trans[1] = y_m;
  message.quat[0] = 1.0;
  return message;
}

TEST(RobotScene, MovesThePathWithTheKeyframesBesideIt) {
  RobotScene scene(100);
  scene.take(map_of(2, 0), 0);
  scene.take(keyframe(0, 0.0, 0.0), 0);
  scene.take(pose(0.2, 1), 0);
  scene.take(keyframe(1, 10.0, 0.0), 0);
  scene.take(pose(10.2, 2), 0);
  EXPECT_FALSE(scene.keyframe_due(1));
  scene.take(map_of(2, 1), 0);  // a loop was closed
  EXPECT_EQ(scene.keyframe_due(2), 0);
  EXPECT_FALSE(scene.keyframe_due(3)) << "asked already";
  scene.take(keyframe(0, 0.0, 0.0), 0);
  EXPECT_EQ(scene.keyframe_due(2'000'000), 1);
  scene.take(keyframe(1, 10.0, 0.5), 0);
  EXPECT_EQ(path_of(scene, "path/0"),
            (std::vector<float>{0.2F, 0.0F, 0.0F, 1.0F, 10.2F, 0.5F, 0.0F, 1.0F}));
  EXPECT_FALSE(scene.keyframe_due(4'000'000));
}

TEST(RobotScene, MovesNothingThatWasDrawnSinceTheLoop) {
  RobotScene scene(100);
  scene.take(map_of(1, 0), 0);
  scene.take(keyframe(0, 0.0, 0.0), 0);
  scene.take(pose(0.2, 1), 0);
  scene.take(map_of(1, 1), 0);
  scene.take(pose(0.4, 2), 0);
  scene.take(keyframe(0, 0.0, 1.0), 0);
  EXPECT_EQ(path_of(scene, "path/0"),
            (std::vector<float>{0.2F, 1.0F, 0.0F, 1.0F, 0.4F, 0.0F, 0.0F, 1.0F}));
}

TEST(RobotScene, LeavesThePathWhereKeyframesOfAnotherMapOrOfNoneAre) {
  RobotScene scene(100);
  scene.take(map_of(1, 0), 0);
  scene.take(keyframe(0, 0.0, 0.0), 0);
  scene.take(pose(0.2, 1), 0);
  keyframe_t other = keyframe(0, 5.0, 5.0);
  other.map_id = 8;
  scene.take(other, 0);
  scene.take(keyframe(-1, 5.0, 5.0), 0);
  scene.take(keyframe(2, 5.0, 5.0), 0);
  keyframe_t broken = keyframe(0, std::numeric_limits<double>::quiet_NaN(), 0.0);
  scene.take(broken, 0);
  EXPECT_EQ(path_of(scene, "path/0"), (std::vector<float>{0.2F, 0.0F, 0.0F, 1.0F}));
}

TEST(RobotScene, ForgetsThePathOfAnotherMap) {
  RobotScene scene(100);
  scene.take(pose(1.0, 1), 0);
  scene.start_over(0);
  EXPECT_EQ(find(scene, "path/0"), nullptr);
  EXPECT_EQ(data(scene, "path").at("first"), 1);
}

TEST(RobotScene, TellsOfEachServiceButOfNoNameThatIsNone) {
  RobotScene scene(100);
  health_t health{};
  health.service = "mapper";
  health.state = health_t::STATE_WARNING;
  health.message = "a \"disk\" \xff";
  scene.take(health, 0);
  EXPECT_EQ(data(scene, "service/mapper").at("state"), "WARNING");
  health.service = "a\",\"b";
  scene.take(health, 0);
  EXPECT_EQ(find(scene, "service/a\",\"b"), nullptr);
}

TEST(RobotScene, TellsObstaclesInCentimetresAndWhereThereIsNone) {
  RobotScene scene(100);
  obstacles_t message{};
  message.n_bearings = 2;
  message.nearest_m.resize(3);
  message.nearest_m[0] = {1.5F, std::numeric_limits<float>::infinity()};
  scene.take(message, 0);
  EXPECT_EQ(data(scene, "obstacles").at("nearest_cm").at(0), json({150, -1}));
}

TEST(RobotScene, NotesALoopThatWasClosed) {
  RobotScene scene(100);
  scene.take(pose(1.0, 1), 0);
  bus::MapChange change;
  scene.take(change, 0);
  EXPECT_EQ(find(scene, "loop"), nullptr);
  change.moves = 1;
  change.T_new_old = {0.3, 0.0, 0.0};
  scene.take(change, 0);
  EXPECT_EQ(data(scene, "loop").at("moved").at(0), 0.3);
}

}  // namespace
}  // namespace voxlist::viewing
