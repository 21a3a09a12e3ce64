#include "voxlist/adapter/cloud_adapter.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "tests/adapter/spinning_laser.h"
#include "voxlist/geometry/mount.h"

namespace voxlist::adapter {
namespace {

using test::DrivingRobot;
using test::kStart_us;
using test::SpinningLaser;
using test::tilted_laser;
using testing::ElementsAre;
using testing::IsEmpty;

std::int64_t at_us(double t_s) { return kStart_us + std::llround(t_s * 1e6); }

// An adapter, and all that came of it.
struct Scene {
  explicit Scene(const AdapterConfig& config) : adapter(config), reports(config.sensors.size()) {}

  void odometry(const DrivingRobot& robot, double from_s, double to_s) {
    for (double t_s = from_s; t_s < to_s + 1e-9; t_s += 0.02)
      take(adapter.add_odometry({at_us(t_s), robot.T_odom_base(t_s)}));
  }
  void cloud(RawCloud raw, std::size_t sensor = 0) {
    take(adapter.add_cloud(sensor, std::move(raw)));
  }
  // One point ahead.
  void point(double t_s, std::size_t sensor = 0, float x_m = 5.0F) {
    RawCloud raw;
    raw.utime_us = at_us(t_s);
    raw.points = {{x_m, 0.0F, 0.0F}};
    cloud(std::move(raw), sensor);
  }

  void take(Adapted adapted) {
    for (Cloud& cloud : adapted.clouds) clouds.push_back(std::move(cloud));
    for (Cloud& slice : adapted.slices) slices.push_back(std::move(slice));
    incomplete += adapted.incomplete;
    for (std::size_t i = 0; i < reports.size(); ++i)
      for (std::size_t fate = 0; fate < kMessageFates; ++fate)
        reports[i].messages[fate] += adapted.sensors[i].messages[fate];
  }
  std::int64_t count(MessageFate fate, std::size_t sensor = 0) const {
    return reports[sensor][fate];
  }
  std::vector<std::int64_t> times_ms() const {
    std::vector<std::int64_t> times;
    for (const Cloud& cloud : clouds) times.push_back((cloud.utime_us - kStart_us) / 1000);
    return times;
  }

  CloudAdapter adapter;
  std::vector<Cloud> clouds, slices;
  std::vector<SensorReport> reports;
  std::int64_t incomplete = 0;
};

AdapterConfig with(const std::vector<SensorConfig>& sensors) {
  AdapterConfig config;
  config.sensors = sensors;
  return config;
}

// Sensors that say nothing of times.
AdapterConfig standing(int sensors) {
  AdapterConfig config;
  config.use_odometry = false;
  for (int i = 0; i < sensors; ++i) {
    config.sensors.emplace_back().channel = "LASER_" + std::to_string(i);
    config.sensors.back().mount_y_m = i;
  }
  return config;
}

TEST(CloudAdapter, PutsEachPointOfASweepWhereTheRobotWasThen) {
  const SpinningLaser laser = tilted_laser();
  const DrivingRobot robot;
  Scene scene(with({laser.sensor}));
  scene.odometry(robot, 0.0, 0.4);
  scene.cloud(laser.sweep(0.25));
  ASSERT_EQ(scene.clouds.size(), 1u);
  const Cloud& cloud = scene.clouds[0];
  EXPECT_NEAR(static_cast<double>(cloud.utime_us - at_us(0.35)), 0.0, 20.0);
  const double end_s = static_cast<double>(cloud.utime_us - kStart_us) * 1e-6;
  const Pose3 T_odom_base = robot.T_odom_base(end_s);
  EXPECT_LT(test::greatest_error_m(cloud, laser.truth(robot, 0.25), T_odom_base), 0.0005);
  ASSERT_EQ(cloud.origins.size(), cloud.points.size());
  const Eigen::Vector3d start =
      T_odom_base.inverse() * robot.T_odom_base(0.25) * Eigen::Vector3d(0.3, -0.1, 0.9);
  EXPECT_LT((cloud.origins[0].cast<double>() - start).norm(), 0.0005);
  EXPECT_LT((cloud.origins.back().cast<double>() - Eigen::Vector3d(0.3, -0.1, 0.9)).norm(), 1e-4);

  AdapterConfig skewed = with({laser.sensor});
  skewed.use_odometry = false;
  Scene without(skewed);
  without.cloud(laser.sweep(0.25));
  ASSERT_EQ(without.clouds.size(), 1u);
  EXPECT_GT(test::greatest_error_m(without.clouds[0], laser.truth(robot, 0.25), T_odom_base), 1.0)
      << "what de-skewing is worth";
}

TEST(CloudAdapter, FollowsARobotThatRollsAndPitches) {
  const SpinningLaser laser = tilted_laser();
  const DrivingRobot robot{8.0};
  Scene scene(with({laser.sensor}));
  scene.odometry(robot, 0.0, 0.4);
  scene.cloud(laser.sweep(0.25));
  ASSERT_EQ(scene.clouds.size(), 1u);
  const double end_s = static_cast<double>(scene.clouds[0].utime_us - kStart_us) * 1e-6;
  EXPECT_LT(
      test::greatest_error_m(scene.clouds[0], laser.truth(robot, 0.25), robot.T_odom_base(end_s)),
      0.001);
}

TEST(CloudAdapter, TurnsTheCloudLevelWhenAskedTo) {
  const SpinningLaser laser = tilted_laser();
  const DrivingRobot robot{8.0};
  AdapterConfig config = with({laser.sensor});
  config.level = true;
  Scene scene(config);
  scene.odometry(robot, 0.0, 0.4);
  scene.cloud(laser.sweep(0.25));
  ASSERT_EQ(scene.clouds.size(), 1u);
  const double end_s = static_cast<double>(scene.clouds[0].utime_us - kStart_us) * 1e-6;
  const Pose3 tilted = robot.T_odom_base(end_s);
  EXPECT_LT(test::greatest_error_m(scene.clouds[0], laser.truth(robot, 0.25), levelled(tilted)),
            0.001);
  EXPECT_GT((levelled(tilted).matrix() - tilted.matrix()).norm(), 0.05);
}

TEST(CloudAdapter, DeskewsAtConstantRateWithoutATimeChannel) {
  SpinningLaser laser = tilted_laser();
  laser.sensor.time_channel.clear();
  laser.sensor.sweep_ms = 100.0;
  const DrivingRobot robot;
  for (const SweepOrder order : {SweepOrder::kRows, SweepOrder::kClockwise}) {
    laser.sensor.sweep_order = order;
    Scene scene(with({laser.sensor}));
    scene.odometry(robot, 0.0, 0.4);
    scene.cloud(laser.sweep(0.25));
    ASSERT_EQ(scene.clouds.size(), 1u);
    EXPECT_EQ(scene.clouds[0].utime_us, at_us(0.35));
    // The points of a column are 0.2 ms apart, which the turn does not tell.
    EXPECT_LT(
        test::greatest_error_m(scene.clouds[0], laser.truth(robot, 0.25), robot.T_odom_base(0.35)),
        0.006);
  }
}

TEST(CloudAdapter, WaitsForOdometryAsLongAsItIsNotThere) {
  const SpinningLaser laser = tilted_laser();
  const DrivingRobot robot;
  Scene scene(with({laser.sensor}));
  scene.odometry(robot, 0.0, 0.28);
  scene.cloud(laser.sweep(0.25));
  EXPECT_TRUE(scene.clouds.empty());
  scene.odometry(robot, 0.30, 0.30);
  EXPECT_TRUE(scene.clouds.empty());
  scene.odometry(robot, 0.32, 0.34);  // within 25 ms of the sweep's end
  EXPECT_EQ(scene.clouds.size(), 1u);
}

TEST(CloudAdapter, DropsWhatOdometryDoesNotReachInTime) {
  const SpinningLaser laser = tilted_laser();
  Scene scene(with({laser.sensor}));
  for (int i = 0; i < 8; ++i) scene.cloud(laser.sweep(0.1 * i));
  EXPECT_TRUE(scene.clouds.empty());
  EXPECT_EQ(scene.count(MessageFate::kNoOdometry), 5);
  scene.odometry({}, 0.4, 0.9);
  EXPECT_EQ(scene.clouds.size(), 3u) << "the last three have waited for less than 200 ms";
}

TEST(CloudAdapter, NeedsNoOdometryForALaserWhosePointsAreOfOneTime) {
  AdapterConfig config = standing(1);
  config.use_odometry = true;
  Scene scene(config);
  EXPECT_FALSE(scene.adapter.needs_odometry());
  scene.point(0.0);
  EXPECT_EQ(scene.clouds.size(), 1u);
}

TEST(CloudAdapter, TakesTheNewestOfWhatComesTooFast) {
  AdapterConfig config = standing(1);
  config.max_rate_hz = 5.0;
  Scene scene(config);
  for (int i = 0; i < 20; ++i) scene.point(0.05 * i);
  EXPECT_THAT(scene.times_ms(), ElementsAre(0, 200, 400, 600, 800));
  EXPECT_EQ(scene.count(MessageFate::kUsed), 5);
  EXPECT_EQ(scene.count(MessageFate::kSuperseded), 14)
      << "three of each four, and two of the last three";
}

TEST(CloudAdapter, JoinsSensorsIntoOneCloud) {
  Scene scene(standing(2));
  for (int i = 0; i < 3; ++i) {
    scene.point(0.1 * i, 0);
    EXPECT_EQ(scene.clouds.size(), static_cast<std::size_t>(i));
    scene.point(0.1 * i + 0.04, 1, 7.0F);
  }
  EXPECT_THAT(scene.times_ms(), ElementsAre(40, 140, 240));
  EXPECT_THAT(scene.clouds[1].points,
              ElementsAre(Eigen::Vector3f(5, 0, 0), Eigen::Vector3f(7, 1, 0)));
  EXPECT_THAT(scene.clouds[1].origins,
              ElementsAre(Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(0, 1, 0)));
  EXPECT_EQ(scene.incomplete, 0);
}

TEST(CloudAdapter, BringsJoinedSensorsToOneTime) {
  AdapterConfig config = standing(2);
  config.use_odometry = true;
  Scene scene(config);
  for (int i = 0; i <= 20; ++i)  // straight ahead at 1 m/s
    scene.take(scene.adapter.add_odometry({at_us(0.02 * i), to_pose3(Pose2{0.02 * i, 0.0, 0.0})}));
  scene.point(0.1, 0);
  scene.point(0.15, 1);
  ASSERT_EQ(scene.clouds.size(), 1u);
  EXPECT_NEAR(scene.clouds[0].points[0].x(), 4.95F, 1e-5F);
  EXPECT_NEAR(scene.clouds[0].origins[0].x(), -0.05F, 1e-5F);
  EXPECT_NEAR(scene.clouds[0].points[1].x(), 5.0F, 1e-5F);
}

TEST(CloudAdapter, GoesOnWithoutASensorThatFellSilentAndTakesItBack) {
  Scene scene(standing(2));
  scene.point(0.00, 0);
  scene.point(0.04, 1);
  for (int i = 1; i <= 5; ++i) scene.point(0.1 * i, 0);
  EXPECT_THAT(scene.times_ms(), ElementsAre(40, 200, 300, 400, 500));
  EXPECT_EQ(scene.incomplete, 4);
  scene.point(0.54, 1);
  scene.point(0.60, 0);
  scene.point(0.64, 1);
  scene.point(0.70, 0);
  EXPECT_EQ(scene.clouds.back().points.size(), 2u);
}

TEST(CloudAdapter, PublishesEachSensorsSliceAtOnceAndAtItsOwnRate) {
  AdapterConfig config = standing(2);
  config.slices = true;
  config.max_rate_hz = 1.0;
  Scene scene(config);
  for (int i = 0; i < 4; ++i) {
    scene.point(0.1 * i, 0);
    EXPECT_EQ(scene.slices.size(), 2u * static_cast<std::size_t>(i) + 1u);
    scene.point(0.1 * i + 0.05, 1);
  }
  EXPECT_EQ(scene.slices.size(), 8u);
  EXPECT_EQ(scene.clouds.size(), 1u);
  EXPECT_EQ(scene.slices[3].points.size(), 1u);
}

TEST(CloudAdapter, LeavesOutWhatIsNoLaterThanTheOneBefore) {
  Scene scene(standing(1));
  scene.point(1.0);
  scene.point(1.0);
  scene.point(0.9);
  EXPECT_EQ(scene.count(MessageFate::kOutOfOrder), 2);
  EXPECT_EQ(scene.clouds.size(), 1u);
}

TEST(CloudAdapter, StartsAnewWithTime) {
  Scene scene(standing(1));
  scene.point(100.0);
  scene.point(0.0);
  EXPECT_THAT(scene.times_ms(), ElementsAre(100'000, 0));
}

TEST(CloudAdapter, GivesNoCloudWithoutAPoint) {
  Scene scene(standing(1));
  scene.point(0.0, 0, 0.1F);
  scene.point(0.2, 0, std::numeric_limits<float>::quiet_NaN());
  EXPECT_THAT(scene.clouds, IsEmpty());
  EXPECT_EQ(scene.count(MessageFate::kNoPoints), 2);
}

TEST(CloudAdapter, NamesTheMessageThatACloudEndedWith) {
  CloudAdapter adapter(standing(2));
  RawCloud raw;
  raw.points = {{5.0F, 0.0F, 0.0F}};
  raw.utime_us = kStart_us + 10;
  raw.number = 40;
  adapter.add_cloud(0, raw);
  raw.utime_us = kStart_us;
  raw.number = 41;
  EXPECT_THAT(adapter.add_cloud(1, raw).numbers, ElementsAre(40)) << "which is later";
}

TEST(CloudAdapter, AtTheEndMakesOfWhatWaitsAsMuchAsOdometryAllows) {
  const SpinningLaser laser = tilted_laser();
  Scene scene(with({laser.sensor}));
  scene.odometry({}, 0.0, 0.14);
  scene.cloud(laser.sweep(0.0));
  scene.cloud(laser.sweep(0.1));
  EXPECT_EQ(scene.clouds.size(), 1u);
  scene.take(scene.adapter.finish());
  EXPECT_EQ(scene.clouds.size(), 1u);
  EXPECT_EQ(scene.count(MessageFate::kNoOdometry), 1);
  EXPECT_TRUE(scene.adapter.finish().clouds.empty());
}

TEST(CloudAdapter, RefusesAMessageWhoseTimesMakeNoSense) {
  SpinningLaser laser = tilted_laser();
  laser.sensor.time_unit = TimeUnit::kSeconds;
  Scene scene(with({laser.sensor}));
  RawCloud raw = laser.sweep(0.0);
  for (float& time : raw.times) time *= 1e9F;
  scene.odometry({}, 0.0, 0.2);
  scene.cloud(raw);
  EXPECT_TRUE(scene.clouds.empty());
  EXPECT_EQ(scene.count(MessageFate::kBadTimes), 1);
}

TEST(CloudAdapter, RefusesSettingsThatDoNotFitTogether) {
  const auto refuses = [](const std::function<void(AdapterConfig&)>& spoil) {
    AdapterConfig config = standing(2);
    spoil(config);
    EXPECT_THROW(CloudAdapter{config}, std::invalid_argument);
  };
  refuses([](AdapterConfig& c) { c.sensors.clear(); });
  refuses([](AdapterConfig& c) { c.sensors[1].channel = ""; });
  refuses([](AdapterConfig& c) { c.sensors[1].channel = "LASER_0"; });
  refuses([](AdapterConfig& c) { c.sensors[1].channel = "CLOUD"; });
  refuses([](AdapterConfig& c) { c.sensors[0].range_min_m = 200.0; });
  refuses([](AdapterConfig& c) { c.robot_boxes_m = {1.0}; });
  refuses([](AdapterConfig& c) { c.level = true; });
  refuses([](AdapterConfig& c) {
    c.sensors[0].time_channel = "time";
    c.sensors[0].sweep_ms = 100.0;
  });
  EXPECT_NO_THROW(CloudAdapter{standing(2)});
}

}  // namespace
}  // namespace voxlist::adapter
