#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <vector>
#include <voxlist/health_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/simulator/simulator_service.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"

namespace voxlist::services {
namespace {

using test::TemporaryFolder;

constexpr std::int64_t kStart_us = 1'700'000'000'000'000;

// A simulator of three seconds, and what others hear of it.
struct Heard {
  explicit Heard(double speed) {
    config.output = "cloud";
    config.speed = speed;
    config.simulation.duration_s = 3.0;
    bus.subscribe(bus::kCloud, [this](const pointcloud_t& m) { clouds.push_back(m); });
    bus.subscribe(bus::kOdometry, [this](const pose_t& m) { odometry.push_back(m); });
    bus.subscribe(bus::kTruth, [this](const pose_t& m) { truth.push_back(m); });
    simulator.emplace(bus, health, config);
  }

  void tick(std::int64_t now_us) {
    simulator->tick(now_us);
    bus.handle(std::chrono::milliseconds(0));
  }

  SimulatorConfig config;
  bus::Bus bus{{.url = "memq://", .prefix = ""}};
  bus::Health health{"simulator"};
  std::optional<SimulatorService> simulator;
  std::vector<pointcloud_t> clouds;
  std::vector<pose_t> odometry, truth;
};

TEST(Simulator, PublishesWhatHasHappenedUntilNowAndNoMore) {
  Heard heard(1.0);
  heard.tick(kStart_us);
  EXPECT_EQ(heard.odometry.size(), 1u);
  heard.tick(kStart_us + 999'999);
  EXPECT_EQ(heard.odometry.size(), 50u);
  EXPECT_TRUE(heard.clouds.empty());
  heard.tick(kStart_us + 1'000'000);
  EXPECT_EQ(heard.odometry.size(), 51u);
  EXPECT_EQ(heard.truth.size(), 1u);
  EXPECT_EQ(heard.clouds.size(), 1u);
}

TEST(Simulator, RunsAsFastAsItIsTold) {
  Heard heard(10.0);
  heard.tick(kStart_us);
  heard.tick(kStart_us + 200'000);
  EXPECT_EQ(heard.clouds.size(), 2u);
  EXPECT_EQ(heard.clouds.back().utime, kStart_us + 2'000'000);
}

TEST(Simulator, PublishesCloudsInBaseWithTheirOriginsCountedFromZero) {
  Heard heard(1.0);
  heard.tick(kStart_us);
  heard.tick(kStart_us + 3'000'000);
  ASSERT_EQ(heard.clouds.size(), 3u);
  for (std::int32_t i = 0; i < 3; ++i) {
    const pointcloud_t& message = heard.clouds[static_cast<std::size_t>(i)];
    EXPECT_EQ(message.seq, i);
    EXPECT_EQ(message.frame_id, "base");
    const bus::ReceivedCloud received = bus::from_message(message);
    ASSERT_TRUE(received.cloud);
    EXPECT_GT(received.cloud->points.size(), 4000u);
    EXPECT_EQ(received.cloud->origins.size(), received.cloud->points.size());
  }
  EXPECT_EQ(heard.truth.back().utime, heard.clouds.back().utime);
}

TEST(Simulator, SaysInItsHealthThatTheTourIsOver) {
  Heard heard(1.0);
  heard.tick(kStart_us);
  EXPECT_EQ(heard.health.due(kStart_us)->message, "");
  heard.tick(kStart_us + 4'000'000);
  EXPECT_EQ(heard.health.due(kStart_us + 4'000'000)->message, "the tour is over");
  const std::size_t before = heard.odometry.size();
  heard.tick(kStart_us + 9'000'000);
  EXPECT_EQ(heard.odometry.size(), before);
}

struct ScannerSimulator {
  ScannerSimulator() {
    config.laser_port = folder / "laser";
    config.clock_port = folder / "clock";
    config.simulation.duration_s = 3.0;
    bus.subscribe(bus::kCloud, [this](const pointcloud_t&) { ++clouds; });
    bus.subscribe(bus::kTruth, [this](const pose_t& m) { truth.push_back(m); });
  }

  TemporaryFolder folder;
  SimulatorConfig config;
  bus::Bus bus{{.url = "memq://", .prefix = ""}};
  bus::Health health{"simulator"};
  int clouds = 0;
  std::vector<pose_t> truth;
};

TEST(Simulator, IsAScannerOnPortsUnlessToldOtherwiseAndTellsTheTruthWithOdometry) {
  ScannerSimulator scene;
  SimulatorService simulator(scene.bus, scene.health, scene.config);
  simulator.tick(kStart_us);
  EXPECT_TRUE(std::filesystem::is_symlink(scene.config.laser_port));
  EXPECT_TRUE(std::filesystem::is_symlink(scene.config.clock_port));
  simulator.tick(kStart_us + 2'000'000);
  scene.bus.handle(std::chrono::milliseconds(0));
  EXPECT_EQ(scene.clouds, 0);
  EXPECT_EQ(scene.truth.size(), 101u);
}

TEST(Simulator, RefusesAnOutputThatIsNoneAndPortsThatAreFasterThanReal) {
  ScannerSimulator scene;
  scene.config.speed = 2.0;
  EXPECT_THROW(SimulatorService(scene.bus, scene.health, scene.config), std::invalid_argument);
  scene.config.speed = 1.0;
  scene.config.output = "clouds";
  EXPECT_THROW(SimulatorService(scene.bus, scene.health, scene.config), std::invalid_argument);
}

}  // namespace
}  // namespace voxlist::services
