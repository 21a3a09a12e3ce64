#include "voxlist/adapter/sensor_points.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "voxlist/adapter/adapter_report.h"

namespace voxlist::adapter {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

std::int64_t count(const TimedPoints& placed, PointFate fate) {
  return placed.counts[static_cast<std::size_t>(fate)];
}

TimedPoints place(const SensorConfig& sensor, const std::vector<Eigen::Vector3f>& points,
                  const std::vector<double>& boxes = {}, const PointTimes& times = {}) {
  RawCloud raw;
  raw.utime_us = 1'000'000;
  raw.points = points;
  return SensorPoints(sensor).place(raw, times, BodyBoxes(boxes, "boxes"));
}

TEST(SensorPoints, AreInBase) {
  SensorConfig sensor;
  sensor.mount_x_m = 0.2;
  sensor.mount_z_m = 0.8;
  sensor.mount_yaw_deg = 90.0;
  const TimedPoints placed = place(sensor, {{2.0F, 1.0F, 0.5F}});
  ASSERT_EQ(placed.points.size(), 1u);
  EXPECT_LT((placed.points[0] - Eigen::Vector3d(0.2 - 1.0, 2.0, 1.3)).norm(), 1e-12);
  EXPECT_LT((placed.origin - Eigen::Vector3d(0.2, 0.0, 0.8)).norm(), 1e-12);
}

TEST(SensorPoints, KeepTheRangeFromTheSensorAndNotFromBase) {
  SensorConfig sensor;
  sensor.mount_x_m = 5.0;
  sensor.range_min_m = 1.0;
  sensor.range_max_m = 10.0;
  const TimedPoints placed =
      place(sensor, {{0.99F, 0, 0}, {1.0F, 0, 0}, {-5.0F, 0, 0}, {10.0F, 0, 0}, {0, 10.01F, 0}});
  EXPECT_EQ(placed.points.size(), 3u);
  EXPECT_EQ(count(placed, PointFate::kTooNear), 1);
  EXPECT_EQ(count(placed, PointFate::kTooFar), 1);
}

TEST(SensorPoints, LeaveOutTheRobotItself) {
  SensorConfig sensor;
  sensor.mount_z_m = 1.0;
  const TimedPoints placed =
      place(sensor, {{0.5F, 0, -0.5F}, {0.5F, 0.0F, 0.5F}}, {-1.0, 1.0, -1.0, 1.0, 0.0, 0.9});
  ASSERT_EQ(placed.points.size(), 1u);
  EXPECT_NEAR(placed.points[0].z(), 1.5, 1e-9);
  EXPECT_EQ(count(placed, PointFate::kRobot), 1);
}

TEST(SensorPoints, LeaveOutWhatIsNoMeasurement) {
  const TimedPoints placed =
      place({}, {{kNan, 1, 1}, {1, kInf, 1}, {0, 0, 0}, {3e38F, 3e38F, 3e38F}, {1.0F, 1.0F, 1.0F}});
  EXPECT_EQ(placed.points.size(), 1u);
  EXPECT_EQ(count(placed, PointFate::kNoReturn), 3);
  EXPECT_EQ(count(placed, PointFate::kTooFar), 1);
}

TEST(SensorPoints, KeepTheirTimesAndLeaveOutThoseWithout) {
  PointTimes times;
  times.offsets_s = {-0.1F, kNan, 0.0F};
  times.first_s = -0.1;
  SensorConfig sensor;
  sensor.latency_ms = 5.0;
  const TimedPoints placed = place(sensor, {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {}, times);
  EXPECT_THAT(placed.offsets_s, testing::ElementsAre(-0.1F, 0.0F));
  EXPECT_EQ(count(placed, PointFate::kNoTime), 1);
  EXPECT_EQ(placed.first_us, 895'000);
  EXPECT_EQ(placed.last_us, 995'000);
}

TEST(SensorPoints, RefuseRangesThatLeaveNothing) {
  SensorConfig sensor;
  sensor.range_min_m = 10.0;
  sensor.range_max_m = 10.0;
  EXPECT_THROW(SensorPoints{sensor}, std::invalid_argument);
}

TEST(SensorPoints, HaveANameForEachFate) {
  EXPECT_STREQ(counter_name(PointFate::kPoint), "points");
  EXPECT_STREQ(counter_name(PointFate::kRobot), "robot");
  EXPECT_STREQ(counter_name(MessageFate::kUsed), "used");
  EXPECT_STREQ(counter_name(MessageFate::kOverflow), "overflow");
}

}  // namespace
}  // namespace voxlist::adapter
