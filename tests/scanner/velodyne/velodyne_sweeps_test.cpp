#include "voxlist/scanner/velodyne/velodyne_sweeps.h"

#include <gtest/gtest.h>

#include "tests/scanner/velodyne/velodyne_encoder.h"

namespace voxlist::scanner {
namespace {

constexpr std::int64_t kStart_us = 1'700'000'000'000'000;

// A laser whose packets arrive when they end.
struct Laser {
  std::optional<VelodyneSweep> say() {
    const auto bytes = encoder.packet([](int, int) { return std::pair{5'000, 10}; });
    arrival_us += encoder.packet_us();
    return sweeps.add(read_velodyne(bytes), kStart_us + static_cast<std::int64_t>(arrival_us));
  }
  std::vector<VelodyneSweep> say(int packets) {
    std::vector<VelodyneSweep> all;
    for (int i = 0; i < packets; ++i)
      if (auto sweep = say()) all.push_back(std::move(*sweep));
    return all;
  }

  test::VelodyneEncoder encoder;
  VelodyneSweeps sweeps;
  double arrival_us = 0.0;
};

TEST(VelodyneSweeps, BeginBehindTheLaserAndGoOnceRound) {
  Laser laser;  // 900 blocks a turn, 10.05 Hz
  const auto sweeps = laser.say(240);
  ASSERT_EQ(sweeps.size(), 3u);
  EXPECT_EQ(sweeps[0].points.size(), 450u * 32u) << "from azimuth 0 to behind it";
  for (std::size_t i = 1; i < 3; ++i) {
    ASSERT_EQ(sweeps[i].points.size(), 900u * 32u);
    EXPECT_LT(sweeps[i].after_s.front(), 1e-6F);
    EXPECT_NEAR(sweeps[i].after_s.back(), 900 * 110.592e-6, 100e-6);
    EXPECT_LT(sweeps[i].points.front().x(), -9.0F);
    EXPECT_EQ(sweeps[i].rings[15], 15.0F);
    EXPECT_EQ(sweeps[i].intensities[15], 10.0F);
  }
  EXPECT_NEAR(static_cast<double>(sweeps[2].utime_us - sweeps[1].utime_us), 900 * 110.592, 2.0);
  EXPECT_NEAR(static_cast<double>(sweeps[1].utime_us - kStart_us), 1327.1 + 450 * 110.592, 3.0);
  EXPECT_EQ(laser.sweeps.missing_packets(), 0);
  EXPECT_TRUE(laser.sweeps.finish());
  EXPECT_FALSE(laser.sweeps.finish());
}

TEST(VelodyneSweeps, TimeGoesOnOverTheHour) {
  Laser laser;
  laser.encoder.stamp_us = 3'599'950'000;
  const auto sweeps = laser.say(240);
  ASSERT_EQ(sweeps.size(), 3u);
  EXPECT_NEAR(static_cast<double>(sweeps[1].utime_us - sweeps[0].utime_us), 450 * 110.592, 3.0);
  EXPECT_NEAR(static_cast<double>(laser.sweeps.drift_us()), 0.0, 5.0);
  EXPECT_EQ(laser.sweeps.missing_packets(), 0);
}

TEST(VelodyneSweeps, CountsWhatIsMissingOrLate) {
  Laser laser;
  laser.say(10);
  laser.encoder.packet([](int, int) { return std::pair{0, 0}; });
  laser.encoder.packet([](int, int) { return std::pair{0, 0}; });
  laser.say(10);
  EXPECT_EQ(laser.sweeps.missing_packets(), 2);
  laser.encoder.stamp_us -= 3'000;
  laser.say(1);
  EXPECT_EQ(laser.sweeps.late_packets(), 1);
}

TEST(VelodyneSweeps, EndWhereTheLaserStandsStill) {
  Laser laser;
  laser.encoder.turn_cdeg = 0;
  EXPECT_GE(laser.say(2'000).size(), 4u);
}

TEST(VelodyneSweeps, TakeTheArrivalsTimeAfterAPause) {
  Laser laser;
  laser.say(10);
  laser.arrival_us += 3'000e6;
  laser.encoder.stamp_us += 20'000'000;  // it was started again
  laser.say(10);
  EXPECT_NEAR(static_cast<double>(laser.sweeps.drift_us()), 0.0, 20.0);
}

}  // namespace
}  // namespace voxlist::scanner
