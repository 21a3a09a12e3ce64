#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <vector>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/localiser/localiser_service.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/map_convert.h"

namespace voxlist::services {
namespace {

constexpr std::int64_t kStart_us = 1'700'000'000'000'000;

// Walls and a few boxes, as seen from the middle.
Cloud room(std::int64_t utime_us) {
  Cloud cloud;
  cloud.utime_us = utime_us;
  for (float s = -3.f; s < 3.f; s += 0.06f) {
    for (float z = 0.f; z < 2.f; z += 0.1f) {
      cloud.points.emplace_back(s, 2.5f, z);
      cloud.points.emplace_back(3.f, s, z);
      if (s < 1.f) cloud.points.emplace_back(-3.f, s, z);
      if (s < -1.f) cloud.points.emplace_back(s, -2.f, z);
      if (s > 0.f && s < 0.5f) cloud.points.emplace_back(s + 1.f, 1.5f, z);
    }
  }
  return cloud;
}

// The service, and a test that plays the sensors and the mapper.
struct Scene {
  Scene() : service(bus, health, {}) {
    bus.subscribe(bus::kLocalisation,
                  [this](const localisation_t& m) { localisations.push_back(m); });
    bus.subscribe(bus::kPose, [this](const pose_t& m) { poses.push_back(m); });
    bus.subscribe(bus::kMapRequest, [this](const map_request_t& m) { requests.push_back(m); });
  }

  void run(std::int64_t now_us) {
    bus.handle(std::chrono::milliseconds(0));
    service.tick(now_us);
    bus.handle(std::chrono::milliseconds(0));
  }

  void send_map(const OccupancyMap& map, std::int64_t utime_us, std::int64_t map_id = 7) {
    bus::MapChange change;
    change.utime_us = utime_us;
    change.map_id = map_id;
    change.version = map.empty() ? 0 : 1;
    change.resolution = bus::resolution_of(map);
    change.blocks = bus::to_messages(map);
    for (const auto& message : bus::split_map(std::move(change)))
      bus.publish(bus::kMapUpdate, message);
  }

  void send_cloud(std::int64_t utime_us) {
    bus.publish(bus::kCloud, bus::to_message(room(utime_us), "base", 0));
  }

  bus::Bus bus{{.url = "memq://", .prefix = ""}};
  bus::Health health{"localiser"};
  LocaliserService service;
  std::vector<localisation_t> localisations;
  std::vector<pose_t> poses;
  std::vector<map_request_t> requests;
};

OccupancyMap map_of_room() {
  OccupancyMap map;
  add_scan(room(0), Pose3::Identity(), 100.0, map);
  return map;
}

TEST(LocaliserService, AsksForAMapOnceASecondAndClaimsNoPoseWithoutOne) {
  Scene scene;
  scene.send_cloud(kStart_us);
  for (int i = 0; i <= 30; ++i) scene.run(kStart_us + i * 100'000);
  EXPECT_EQ(scene.requests.size(), 4u);
  ASSERT_EQ(scene.localisations.size(), 1u);
  EXPECT_EQ(scene.localisations[0].state, localisation_t::STATE_LOST);
  EXPECT_TRUE(scene.poses.empty());
}

TEST(LocaliserService, AnEmptyMapIsBegunByTheFirstCloud) {
  Scene scene;
  scene.send_map({}, 0);
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  ASSERT_EQ(scene.localisations.size(), 1u);
  EXPECT_EQ(scene.localisations[0].state, localisation_t::STATE_TRACKING);
  EXPECT_EQ(scene.localisations[0].map_id, 7);
  EXPECT_EQ(scene.localisations[0].map_version, 0);
  EXPECT_EQ(scene.poses.size(), 1u);
}

TEST(LocaliserService, FindsACloudInTheMapThatItWasSent) {
  Scene scene;
  scene.send_map(map_of_room(), 0);
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  ASSERT_EQ(scene.localisations.size(), 1u);
  const auto& found = scene.localisations[0];
  ASSERT_EQ(found.state, localisation_t::STATE_TRACKING);
  EXPECT_NEAR(found.modes.at(0).pose[0], 0.0, 0.03);
  EXPECT_NEAR(found.modes.at(0).pose[1], 0.0, 0.03);
  EXPECT_EQ(found.utime, kStart_us);
  EXPECT_GT(found.poses_examined, 0);
}

TEST(LocaliserService, TheNextCloudWaitsForTheMappersWordButNotForEver) {
  Scene scene;
  scene.send_map(map_of_room(), 0);
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  scene.send_cloud(kStart_us + 1'000'000);
  scene.run(kStart_us + 1'000'000);
  EXPECT_EQ(scene.localisations.size(), 1u);
  bus::MapChange nothing_new{.utime_us = kStart_us,
                             .map_id = 7,
                             .version = 1,
                             .base_version = 1,
                             .resolution = bus::resolution_of({}),
                             .blocks = {}};
  for (const auto& message : bus::split_map(nothing_new))
    scene.bus.publish(bus::kMapUpdate, message);
  scene.run(kStart_us + 1'000'001);
  EXPECT_EQ(scene.localisations.size(), 2u);

  scene.send_cloud(kStart_us + 2'000'000);
  scene.run(kStart_us + 2'000'000);
  EXPECT_EQ(scene.localisations.size(), 2u);
  scene.run(kStart_us + 2'600'000);
  EXPECT_EQ(scene.localisations.size(), 3u);
}

TEST(LocaliserService, PublishesPosesBetweenCloudsFromOdometry) {
  Scene scene;
  scene.send_map(map_of_room(), 0);
  scene.bus.publish(bus::kOdometry, bus::to_message(StampedPose2{kStart_us, {10.0, 5.0, 1.0}}));
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  scene.bus.publish(bus::kOdometry,
                    bus::to_message(StampedPose2{kStart_us + 100'000,
                                                 Pose2{10.0, 5.0, 1.0} * Pose2{0.05, 0.0, 0.0}}));
  scene.run(kStart_us + 100'000);
  ASSERT_EQ(scene.poses.size(), 2u);
  EXPECT_EQ(scene.poses[1].utime, kStart_us + 100'000);
  EXPECT_NEAR(scene.poses[1].pos[0], scene.poses[0].pos[0] + 0.05, 0.002);
  EXPECT_NEAR(scene.poses[1].vel[0], 0.5, 0.02);
}

TEST(LocaliserService, ForgetsWhereItWasWhenTheMapIsAnother) {
  Scene scene;
  scene.send_map(map_of_room(), 0, 7);
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  scene.send_map(map_of_room(), kStart_us, 8);
  scene.run(kStart_us + 500'000);
  scene.send_cloud(kStart_us + 1'000'000);
  scene.run(kStart_us + 1'000'000);
  ASSERT_EQ(scene.localisations.size(), 2u);
  EXPECT_EQ(scene.localisations[1].map_id, 8);
  EXPECT_TRUE(scene.localisations[1].searched_whole_map);
}

TEST(LocaliserService, AForgedTimeDoesNotShutOutTheCloudsAfterIt) {
  Scene scene;
  scene.send_map(map_of_room(), 0);
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  scene.send_cloud(kStart_us + 30'000'000);
  scene.run(kStart_us + 1'000'000);
  for (int i = 2; i < 10; ++i) {
    scene.send_cloud(kStart_us + i * 1'000'000);
    scene.run(kStart_us + i * 1'000'000);
    scene.run(kStart_us + i * 1'000'000 + 600'000);  // no mapper answers: it waits for 0.5 s
  }
  EXPECT_EQ(scene.localisations.size(), 2u + 8u - 2u);
  EXPECT_EQ(scene.localisations.back().utime, kStart_us + 9'000'000);
}

TEST(LocaliserService, TellsThatOdometryIsOfAnotherTime) {
  Scene scene;
  scene.send_map(map_of_room(), 0);
  const std::int64_t old_us = kStart_us - 12'000'000;
  scene.bus.publish(bus::kOdometry, bus::to_message(StampedPose2{old_us, {}}));
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  EXPECT_EQ(scene.health.message(),
            "ODOMETRY is 12.0 s older than CLOUD and is not used: do their clocks agree?");
  scene.bus.publish(bus::kOdometry, bus::to_message(StampedPose2{kStart_us + 1'000'000, {}}));
  scene.send_cloud(kStart_us + 1'000'000);
  scene.run(kStart_us + 1'000'000);
  scene.run(kStart_us + 6'000'000);
  EXPECT_EQ(scene.health.message().find("older"), std::string::npos) << scene.health.message();
}

TEST(LocaliserService, TellsThatOdometryIsNoPose) {
  Scene scene;
  pose_t message{};
  message.utime = kStart_us;
  scene.bus.publish(bus::kOdometry, message);
  scene.run(kStart_us);
  EXPECT_NE(scene.health.message().find("ODOMETRY is no pose"), std::string::npos);
}

}  // namespace
}  // namespace voxlist::services
