#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>
#include <voxlist/health_t.hpp>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/cloud_assembler/cloud_assembler_service.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"

namespace voxlist::services {
namespace {

using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;
constexpr std::int64_t kSecond_us = 1'000'000;
constexpr std::int64_t kStart_us = 1'700'000'000 * kSecond_us;

// The service, a test that plays the sensors, and what others hear. A sweep is 1 s, 75 lines.
struct Scene {
  explicit Scene(const scanner::CloudAssemblerConfig& config = {}) : service(bus, health, config) {
    bus.subscribe(bus::kCloud, [this](const pointcloud_t& m) { clouds.push_back(m); });
    bus.subscribe(bus::kCloudSlice, [this](const pointcloud_t& m) { slices.push_back(m); });
    service.tick(now_us);
  }

  void laser(std::int64_t utime_us) {
    LaserLine line;
    line.utime_us = utime_us;
    line.ranges_m.assign(181, 2.0F);
    bus.publish(bus::kLaser, bus::to_message(line));
  }
  void mirror(std::int64_t utime_us, bool known = true, const std::string& reason = "") {
    MirrorState state;
    state.utime_us = utime_us;
    const auto turning = reason.empty() ? MirrorState::State::kLocked : MirrorState::State::kFault;
    state.state = known ? turning : MirrorState::State::kStalled;
    state.angle_known = known;
    state.reason = reason;
    const double angle_rad = kPi * static_cast<double>(utime_us - kStart_us) * 1e-6;
    state.angle_rad = std::fmod(angle_rad, 2.0 * kPi);
    state.rate_radps = kPi;
    bus.publish(bus::kMirror, bus::to_message(state));
  }
  void odometry(std::int64_t utime_us) {
    bus.publish(bus::kOdometry, bus::to_message(StampedPose2{utime_us, {1.0, 2.0, 0.5}}));
  }

  struct Speaking {
    bool laser = true, mirror = true, odometry = true;
  };

  // One line's time, in which those speak that do.
  void step(const Speaking& speaking) {
    if (speaking.odometry) odometry(now_us);
    if (speaking.mirror) mirror(now_us);
    if (speaking.laser) laser(now_us);
    hear();
    now_us += 13'333;
    service.tick(now_us);
  }
  void play(int lines, const Speaking& speaking) {
    for (int i = 0; i < lines; ++i) step(speaking);
  }
  void play(int lines) { play(lines, Speaking{}); }

  void hear() {
    for (int i = 0; i < 3; ++i) bus.handle(std::chrono::milliseconds(0));
  }

  health_t told() { return health.due(health_us += 2 * kSecond_us).value(); }

  std::int64_t counted(const std::string& name) {
    const health_t message = told();
    for (const counter_t& counter : message.counters)
      if (counter.name == name) return counter.count;
    return 0;
  }

  bus::Bus bus{{.url = "memq://", .prefix = ""}};
  bus::Health health{"cloud_assembler"};
  CloudAssemblerService service;
  std::int64_t now_us = kStart_us, health_us = 0;
  std::vector<pointcloud_t> clouds, slices;
};

TEST(CloudAssemblerService, PublishesACloudOfEachSweepAndItsSlices) {
  Scene scene;
  scene.play(230);
  ASSERT_EQ(scene.clouds.size(), 3u);
  EXPECT_EQ(scene.slices.size(), 46u);
  EXPECT_EQ(scene.clouds[0].seq, 0);
  EXPECT_EQ(scene.clouds[2].seq, 2);
  EXPECT_EQ(scene.clouds[2].frame_id, "base");
  EXPECT_EQ(scene.clouds[2].utime - scene.clouds[1].utime, 75 * 13'333);
  EXPECT_GT(scene.clouds[1].n_points, 8'000);
  EXPECT_EQ(scene.clouds[1].n_channels, 3);
  EXPECT_EQ(scene.counted("LASER/assembled"), 230);
  EXPECT_EQ(scene.told().state, health_t::STATE_OK);
}

TEST(CloudAssemblerService, PublishesInTheHandlingOfTheLineThatCompletesTheCloud) {
  Scene scene;
  while (scene.clouds.empty() && scene.now_us < kStart_us + 2 * kSecond_us) {
    scene.odometry(scene.now_us);
    scene.mirror(scene.now_us);
    scene.hear();
    ASSERT_TRUE(scene.clouds.empty());
    scene.laser(scene.now_us);
    scene.hear();
    scene.now_us += 13'333;
  }
  EXPECT_EQ(scene.clouds.size(), 1u);
  scene.service.tick(kStart_us * 2);
  EXPECT_GE(scene.told().latency_max_ms, 0.0F);
}

TEST(CloudAssemblerService, SaysWhoIsSilent) {
  {
    Scene scene;
    scene.play(100, {.laser = false});
    EXPECT_THAT(scene.told().message, HasSubstr("no LASER"));
  }
  {
    Scene scene;
    scene.play(100, {.mirror = false});
    EXPECT_THAT(scene.told().message, HasSubstr("no MIRROR"));
  }
  Scene scene;
  scene.play(100, {.odometry = false});
  const health_t told = scene.told();
  EXPECT_THAT(told.message, HasSubstr("no ODOMETRY"));
  EXPECT_EQ(told.state, health_t::STATE_ERROR);
  EXPECT_TRUE(scene.clouds.empty());
  scene.play(100);
  EXPECT_NE(scene.told().state, health_t::STATE_ERROR) << "all are there again";
}

TEST(CloudAssemblerService, DoesNotMissOdometryThatItDoesNotUse) {
  scanner::CloudAssemblerConfig config;
  config.use_odometry = false;
  Scene scene(config);
  scene.play(160, {.odometry = false});
  EXPECT_EQ(scene.clouds.size(), 2u);
  EXPECT_EQ(scene.told().state, health_t::STATE_OK);
}

TEST(CloudAssemblerService, PassesOnWhatTheMirrorSuffersFrom) {
  Scene scene;
  scene.play(10);
  scene.mirror(scene.now_us, true, "arm 1 missing");
  scene.hear();
  scene.service.tick(scene.now_us);
  health_t told = scene.told();
  EXPECT_THAT(told.message, HasSubstr("arm 1 missing"));
  EXPECT_EQ(told.state, health_t::STATE_WARNING);

  scene.mirror(scene.now_us + 1, false, "stalled");
  scene.hear();
  scene.service.tick(scene.now_us);
  told = scene.told();
  EXPECT_THAT(told.message, HasSubstr("stalled"));
  EXPECT_EQ(told.state, health_t::STATE_ERROR);
}

TEST(CloudAssemblerService, SaysWhenASweepLacksLines) {
  Scene scene;
  scene.play(90);
  scene.play(20, {.laser = false});
  scene.play(50);
  EXPECT_THAT(scene.told().message, HasSubstr("73 % of its lines"));
  EXPECT_EQ(scene.counted("LASER/missing"), 20);
  scene.play(75);
  EXPECT_EQ(scene.told().message, "");
}

TEST(CloudAssemblerService, SaysWhenNoLineCanBeUsed) {
  Scene scene;
  for (int i = 0; i < 100; ++i) {  // LASER's clock is an hour off
    scene.laser(scene.now_us + 3600 * kSecond_us);
    scene.step({.laser = false});
  }
  EXPECT_THAT(scene.told().message, HasSubstr("no line can be used (LASER/no_mirror_yet)"));
}

TEST(CloudAssemblerService, CountsMessagesThatMakeNoSense) {
  Scene scene;
  planar_lidar_t line{};
  line.rad0 = std::numeric_limits<float>::quiet_NaN();
  scene.bus.publish(bus::kLaser, line);
  mirror_state_t mirror{};
  mirror.state = 99;
  scene.bus.publish(bus::kMirror, mirror);
  scene.bus.publish(bus::kOdometry, pose_t{});
  scene.hear();
  EXPECT_EQ(scene.counted("LASER/not_a_line"), 1);
  EXPECT_EQ(scene.counted("MIRROR/not_a_state"), 1);
  EXPECT_EQ(scene.counted("ODOMETRY/not_a_pose"), 1);
}

TEST(CloudAssemblerService, NamesTimesThatDoNotGoOn) {
  Scene scene;
  scene.play(80);
  const auto clouds = scene.clouds.size();
  scene.laser(scene.now_us * 1000);
  scene.mirror(scene.now_us - 3600 * kSecond_us);
  scene.odometry(scene.now_us + 3600 * kSecond_us);
  scene.hear();
  const std::string told = scene.told().message;
  EXPECT_THAT(told, HasSubstr("LASER has a utime that is no microseconds: is it in nanoseconds?"));
  EXPECT_THAT(told, HasSubstr("MIRROR goes back in utime"));
  EXPECT_THAT(told, HasSubstr("ODOMETRY jumps ahead in utime"));
  EXPECT_EQ(scene.counted("LASER/bad_utime"), 1);
  scene.play(150);
  EXPECT_EQ(scene.clouds.size(), clouds + 2) << "they cost themselves alone";
}

TEST(CloudAssemblerService, DoesNotStartWithSettingsThatDoNotFitTogether) {
  scanner::CloudAssemblerConfig config;
  config.robot_boxes_m = {1.0, 2.0};
  EXPECT_THROW(Scene{config}, std::invalid_argument);
}

}  // namespace
}  // namespace voxlist::services
