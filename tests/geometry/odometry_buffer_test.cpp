#include "geometry/odometry_buffer.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace voxlist
