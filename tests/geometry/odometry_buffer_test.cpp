#include "voxlist/geometry/odometry_buffer.h"

#include <gtest/gtest.h>

#include <cmath>

namespace voxlist {
namespace {

constexpr std::int64_t kSecond_us = 1'000'000;

StampedPose2 at_x(std::int64_t utime_us, double x_m) { return {utime_us, {x_m, 0.0, 0.0}}; }

// Which pose the buffer gives, by its x; -1 for none.
double x_at(const OdometryBuffer& buffer, std::int64_t utime_us) {
  const auto pose = buffer.at(utime_us);
  return pose ? pose->x_m : -1.0;
}

TEST(OdometryBuffer, GivesTheLatestPoseThatIsNotAfterTheTime) {
  OdometryBuffer buffer;
  EXPECT_FALSE(buffer.at(100));
  buffer.add(at_x(100, 1.0));
  buffer.add(at_x(200, 2.0));
  EXPECT_EQ(x_at(buffer, 99), -1.0);
  EXPECT_EQ(x_at(buffer, 100), 1.0);
  EXPECT_EQ(x_at(buffer, 199), 1.0);
  EXPECT_EQ(x_at(buffer, 200), 2.0);
  EXPECT_EQ(x_at(buffer, 300), 2.0);
}

TEST(OdometryBuffer, PutsLateComersInTheirPlace) {
  OdometryBuffer buffer;
  buffer.add(at_x(300, 3.0));
  buffer.add(at_x(200, 2.0));
  EXPECT_EQ(x_at(buffer, 250), 2.0);
  EXPECT_EQ(x_at(buffer, 400), 3.0);
}

TEST(OdometryBuffer, SaysNothingWhenItsNewestIsTooOld) {
  OdometryBuffer buffer;
  buffer.add(at_x(0, 1.0));
  EXPECT_EQ(x_at(buffer, OdometryBuffer::kMaxAge_us), 1.0);
  EXPECT_EQ(x_at(buffer, OdometryBuffer::kMaxAge_us + 1), -1.0);
}

TEST(OdometryBuffer, ForgetsWhatWasWhenTimeStartsAnew) {
  OdometryBuffer buffer;
  buffer.add(at_x(100 * kSecond_us, 1.0));
  buffer.add(at_x(5 * kSecond_us, 2.0));
  EXPECT_EQ(x_at(buffer, 5 * kSecond_us), 2.0);
  EXPECT_EQ(x_at(buffer, 100 * kSecond_us), -1.0);
}

TEST(OdometryBuffer, KeepsTheNewestWithinItsBound) {
  OdometryBuffer buffer;
  const auto n = static_cast<std::int64_t>(OdometryBuffer::kCapacity) + 10;
  for (std::int64_t i = 0; i < n; ++i) buffer.add(at_x(i, static_cast<double>(i)));
  EXPECT_EQ(x_at(buffer, 9), -1.0);
  EXPECT_EQ(x_at(buffer, 10), 10.0);
  EXPECT_EQ(x_at(buffer, n), static_cast<double>(n - 1));
}

// A robot on a circle: 0.5 m/s and 45 deg/s.
StampedPose2 on_circle(std::int64_t utime_us) {
  const double speed_mps = 0.5, turn_radps = 0.785, t_s = static_cast<double>(utime_us) * 1e-6;
  const double yaw_rad = turn_radps * t_s, radius_m = speed_mps / turn_radps;
  return {utime_us, {radius_m * std::sin(yaw_rad), radius_m * (1 - std::cos(yaw_rad)), yaw_rad}};
}

OdometryBuffer circle_at_20_hz() {
  OdometryBuffer buffer;
  for (std::int64_t t = 0; t <= kSecond_us; t += 50'000) buffer.add(on_circle(t));
  return buffer;
}

TEST(OdometryBuffer, EstimatesOnTheArcBetweenAndAfterItsPoses) {
  const OdometryBuffer buffer = circle_at_20_hz();
  for (const std::int64_t t : {0L, 12'345L, 50'000L, 777'777L, 1'000'000L, 1'090'000L}) {
    const auto estimate = buffer.estimate(t, 100'000);
    ASSERT_TRUE(estimate) << t;
    EXPECT_NEAR(distance_m(*estimate, on_circle(t).pose), 0.0, 1e-9) << t;
    EXPECT_NEAR(turn_rad(*estimate, on_circle(t).pose), 0.0, 1e-9) << t;
  }
}

TEST(OdometryBuffer, EstimatesNothingThatItWouldHaveToGuess) {
  const OdometryBuffer buffer = circle_at_20_hz();
  EXPECT_FALSE(buffer.estimate(-1, 100'000));
  EXPECT_TRUE(buffer.estimate(1'100'000, 100'000));
  EXPECT_FALSE(buffer.estimate(1'100'001, 100'000));

  OdometryBuffer one_pose;
  one_pose.add(at_x(100, 1.0));
  EXPECT_TRUE(one_pose.estimate(100, 100'000));
  EXPECT_FALSE(one_pose.estimate(101, 100'000)) << "no velocity is known";

  OdometryBuffer hole;
  hole.add(at_x(0, 1.0));
  hole.add(at_x(OdometryBuffer::kMaxAge_us + 1, 2.0));
  EXPECT_FALSE(hole.estimate(500'000, 100'000));
}

TEST(OdometryBuffer, TakesNoVelocityFromPosesOfNearlyTheSameTime) {
  OdometryBuffer buffer;
  buffer.add(at_x(0, 0.0));
  buffer.add(at_x(50'000, 0.05));
  buffer.add(at_x(50'010, 0.06));  // a time stamp that is 10 ms off
  EXPECT_NEAR(buffer.estimate(100'000, 100'000)->x_m, 0.12, 0.001);
}

TEST(OdometryBuffer, TellsRollAndPitchWhereTheyAreMeasured) {
  OdometryBuffer buffer;
  buffer.add({1'000'000, {}});
  EXPECT_FALSE(buffer.tilt_at(1'000'000)) << "wheels measure none";
  buffer.add({2'000'000, {}}, {0.0, 0.1, -0.2});
  EXPECT_EQ(buffer.tilt_at(2'500'000), (Tilt{0.0, 0.1, -0.2}));
  EXPECT_FALSE(buffer.tilt_at(3'500'000)) << "too old";
}

}  // namespace
}  // namespace voxlist
