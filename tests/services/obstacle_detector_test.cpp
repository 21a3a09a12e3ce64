#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>
#include <voxlist/health_t.hpp>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/obstacle_detector/obstacle_detector_service.h"
#include "services/simulator/simulator_service.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"

namespace voxlist::services {
namespace {

constexpr std::int64_t kSecond_us = 1'000'000;

// An obstacle straight ahead.
pointcloud_t cloud_with_post(float range_m, std::int64_t utime_us) {
  Cloud cloud;
  cloud.utime_us = utime_us;
  // As many points as a lens that is not covered brings.
  for (int i = 0; i < 60; ++i)
    cloud.points.emplace_back(range_m, 0.0F, 0.5F + 0.02F * static_cast<float>(i % 3));
  return bus::to_message(cloud, "base", 0);
}

// How far the building is free along a bearing, from the robot's true pose.
double free_m(const simulation::Building& building, const Pose2& T_map_base, double bearing_rad) {
  for (double range_m = 0.0;; range_m += 0.01) {
    const Eigen::Vector3d p = T_map_base * Eigen::Vector3d(range_m * std::cos(bearing_rad),
                                                           range_m * std::sin(bearing_rad), 0.0);
    if (building.clearance_m({p.x(), p.y()}, 0.1, 1.0) <= 0.0) return range_m;
  }
}

// A detector, and what others hear of it.
struct Heard {
  explicit Heard(const planning::ObstacleConfig& config = {}) : detector(bus, health, config) {
    bus.subscribe(bus::kObstacles, [this](const obstacles_t& m) { obstacles.push_back(m); });
  }

  // Until what has been published is detected, and what was detected is heard.
  void handle() {
    for (int i = 0; i < 3; ++i) bus.handle(std::chrono::milliseconds(0));
  }

  std::int64_t counted(const std::string& name) {
    const std::optional<health_t> message = health.due(0);
    for (const counter_t& counter : message.value().counters)
      if (counter.name == name) return counter.count;
    return 0;
  }

  bus::Bus bus{{.url = "memq://", .prefix = ""}};
  bus::Health health{"obstacle_detector"};
  ObstacleDetectorService detector;
  std::vector<obstacles_t> obstacles;
};

TEST(ObstacleDetector, PublishesTheNearestWallOfTheSimulatedRoom) {
  Heard heard;
  SimulatorConfig config;
  config.output = "cloud";
  config.simulation.perfect_deskew = true;
  bus::Health simulator_health("simulator");
  SimulatorService simulator(heard.bus, simulator_health, config);
  std::optional<pose_t> truth;
  heard.bus.subscribe(bus::kTruth, [&](const pose_t& m) { truth = m; });
  simulator.tick(0);
  simulator.tick(kSecond_us);
  heard.handle();

  ASSERT_TRUE(truth);
  ASSERT_EQ(heard.obstacles.size(), 1u);
  const obstacles_t& message = heard.obstacles[0];
  EXPECT_EQ(message.utime, truth->utime);
  ASSERT_EQ(message.n_bearings, 360);
  const simulation::Building building = simulation::make_building(config.simulation.building);
  const Pose2 T_map_base = to_pose2(bus::from_message(*truth)->pose);
  for (const std::size_t sector : {30u, 150u, 180u, 210u, 330u}) {
    const double bearing_rad = message.rad0 + static_cast<float>(sector) * message.radstep;
    EXPECT_NEAR(message.nearest_m[obstacles_t::OBSTACLE][sector],
                free_m(building, T_map_base, bearing_rad), 0.1)
        << sector;
  }
  EXPECT_EQ(message.nearest_m[obstacles_t::OBSTACLE][90], INFINITY)
      << "the scanner does not see to the side";
  EXPECT_GT(message.n_cells, 20);
  EXPECT_THAT(message.types, testing::Contains(static_cast<int>(obstacles_t::OBSTACLE)));
}

TEST(ObstacleDetector, SaysWhichHeightsItLookedAt) {
  planning::ObstacleConfig config;
  config.min_height_m = 0.25;
  config.max_height_m = 1.75;
  Heard heard(config);
  heard.bus.publish(bus::kCloud, cloud_with_post(2.0F, 5));
  heard.handle();
  ASSERT_EQ(heard.obstacles.size(), 1u);
  EXPECT_FLOAT_EQ(heard.obstacles[0].min_height_m, 0.25F);
  EXPECT_FLOAT_EQ(heard.obstacles[0].max_height_m, 1.75F);
  EXPECT_FLOAT_EQ(heard.obstacles[0].nearest_m[obstacles_t::OBSTACLE][0], 2.0F);
}

TEST(ObstacleDetector, LooksOnlyAtTheNewestOfTheCloudsThatWait) {
  Heard heard;
  for (int i = 1; i <= 3; ++i)
    heard.bus.publish(bus::kCloud, cloud_with_post(static_cast<float>(i), i));
  heard.handle();
  ASSERT_EQ(heard.obstacles.size(), 1u);
  EXPECT_EQ(heard.obstacles[0].utime, 3);
  EXPECT_FLOAT_EQ(heard.obstacles[0].nearest_m[obstacles_t::OBSTACLE][0], 3.0F);
}

TEST(ObstacleDetector, LooksAtSlicesWhereTheyCome) {
  Heard heard;
  heard.detector.tick(kSecond_us);
  heard.obstacles.clear();
  heard.bus.publish(bus::kCloudSlice, cloud_with_post(2.0F, 5));
  heard.bus.publish(bus::kCloudSlice, cloud_with_post(1.5F, 6));
  heard.handle();
  heard.bus.publish(bus::kCloud, cloud_with_post(1.0F, 7));
  heard.handle();
  std::vector<float> ahead_m;
  for (const obstacles_t& o : heard.obstacles)
    if (o.utime < 100) ahead_m.push_back(o.nearest_m[obstacles_t::OBSTACLE][0]);
  EXPECT_THAT(ahead_m, testing::ElementsAre(2.0F, 1.5F));

  heard.detector.tick(4 * kSecond_us);
  heard.obstacles.clear();
  heard.bus.publish(bus::kCloud, cloud_with_post(1.0F, 8));
  heard.handle();
  ASSERT_FALSE(heard.obstacles.empty());
  EXPECT_EQ(heard.obstacles.back().utime, 8);
}

// What was seen 2 m ahead is 1.6 m ahead after 0.4 m.
TEST(ObstacleDetector, MovesWhatItSawByOdometry) {
  Heard heard;
  for (int i = 0; i <= 10; ++i)
    heard.bus.publish(bus::kOdometry, bus::to_message(StampedPose3{
                                          1 + i * 100'000, to_pose3({0.05 * i, 0.0, 0.0})}));
  heard.bus.publish(bus::kCloudSlice, cloud_with_post(2.0F, 200'001));
  pointcloud_t elsewhere = cloud_with_post(3.0F, 1'000'001);
  for (auto& point : elsewhere.points) point[0] = -3.0F;
  heard.bus.publish(bus::kCloudSlice, elsewhere);
  heard.handle();
  ASSERT_EQ(heard.obstacles.size(), 2u);
  EXPECT_NEAR(heard.obstacles[1].nearest_m[obstacles_t::OBSTACLE][0], 1.6, 0.01);
}

TEST(ObstacleDetector, SaysThatItIsBlindFifteenTimesASecond) {
  Heard heard;
  heard.bus.publish(bus::kCloudSlice, cloud_with_post(2.0F, 1));
  heard.handle();
  for (std::int64_t t_us = 4 * kSecond_us; t_us <= 5 * kSecond_us; t_us += 20'000) {
    heard.detector.tick(t_us);
    heard.handle();
  }
  ASSERT_GT(heard.obstacles.size(), 12u);
  EXPECT_LT(heard.obstacles.size(), 18u);
  const obstacles_t& last = heard.obstacles.back();
  EXPECT_NE(last.blind.find("CLOUD_SLICE"), std::string::npos) << last.blind;
  EXPECT_NEAR(static_cast<double>(last.utime), 5e6, 1e5) << "a follower must not take it for old";
  EXPECT_THAT(last.ground_seen_to_m, testing::Each(0.0F));
  EXPECT_EQ(heard.health.due(6 * kSecond_us)->state, health_t::STATE_ERROR);
}

TEST(ObstacleDetector, IsBlindWhileTheMirrorsAngleIsNotKnown) {
  Heard heard;
  MirrorState mirror;
  mirror.utime_us = 1;
  mirror.reason = "it stands";
  heard.bus.publish(bus::kMirror, bus::to_message(mirror));
  heard.handle();
  heard.bus.publish(bus::kCloudSlice, cloud_with_post(2.0F, 1));
  heard.handle();
  ASSERT_EQ(heard.obstacles.size(), 1u);
  EXPECT_NE(heard.obstacles[0].blind.find("it stands"), std::string::npos);
}

TEST(ObstacleDetector, CountsWhatItRefusesAndGoesOn) {
  Heard heard;
  heard.bus.publish(bus::kCloud, cloud_with_post(2.0F, -1));
  heard.handle();
  EXPECT_TRUE(heard.obstacles.empty());
  EXPECT_EQ(heard.counted("CLOUD/bad_utime"), 1);

  pointcloud_t one_bad_point = cloud_with_post(2.0F, 7);
  one_bad_point.points[0][1] = NAN;
  heard.bus.publish(bus::kCloud, one_bad_point);
  heard.handle();
  ASSERT_EQ(heard.obstacles.size(), 1u);
  EXPECT_FLOAT_EQ(heard.obstacles[0].nearest_m[obstacles_t::OBSTACLE][0], 2.0F);
}

TEST(ObstacleDetector, TellsHowLongACloudTook) {
  Heard heard;
  heard.detector.tick(kSecond_us);
  EXPECT_EQ(heard.health.due(kSecond_us)->latency_max_ms, -1.0F);
  std::int64_t arrival_us = 0;
  heard.bus.subscribe(bus::kHealth,
                      [&](const health_t&) { arrival_us = heard.bus.arrival_utime_us(); });
  heard.bus.publish(bus::kHealth, *heard.health.due(2 * kSecond_us));
  heard.bus.publish(bus::kCloud, cloud_with_post(2.0F, 1));
  heard.handle();
  heard.detector.tick(arrival_us + 3600 * kSecond_us);
  EXPECT_NEAR(heard.health.due(3 * kSecond_us)->latency_max_ms, 3.6e6F, 1e5F);
}

TEST(ObstacleDetector, DoesNotStartWhenItCouldNeverSeeAnything) {
  planning::ObstacleConfig upside_down, inside_out;
  upside_down.min_height_m = 1.5;
  inside_out.min_range_m = 50.0;
  EXPECT_THROW(Heard{upside_down}, std::invalid_argument);
  EXPECT_THROW(Heard{inside_out}, std::invalid_argument);
}

}  // namespace
}  // namespace voxlist::services
