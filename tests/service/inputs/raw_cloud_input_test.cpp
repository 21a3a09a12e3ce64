#include "voxlist/service/inputs/raw_cloud_input.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>
#include <vector>
#include <voxlist/pointcloud_t.hpp>

namespace voxlist::service {
namespace {

using testing::HasSubstr;

// So many points, with an intensity and a time, which is the row.
std::vector<std::uint8_t> message_of(int points) {
  pointcloud_t message{};
  message.utime = 42;
  message.n_points = points;
  message.n_channels = 2;
  message.channel_names = {"intensity", "time"};
  message.channels.resize(2);
  for (int i = 0; i < points; ++i) {
    message.points.push_back({static_cast<float>(i), 1.0F, 2.0F});
    message.channels[0].push_back(0.5F);
    message.channels[1].push_back(static_cast<float>(i));
  }
  std::vector<std::uint8_t> bytes;
  EXPECT_EQ(bus::encode(message, bytes), bus::Fault::kNone);
  return bytes;
}

adapter::SensorConfig sensor_with(const std::string& time_channel, int max_points = 30'000) {
  adapter::SensorConfig sensor;
  sensor.channel = "LASER_3D";
  sensor.time_channel = time_channel;
  sensor.max_points = max_points;
  return sensor;
}

TEST(RawCloudInput, TakesPointsWithTheirTimes) {
  const auto bytes = message_of(500);
  const RawCloudInput taken = take_raw_cloud(bus::CloudView(bytes), sensor_with("time"));
  ASSERT_TRUE(taken.cloud);
  EXPECT_EQ(taken.cloud->utime_us, 42);
  EXPECT_EQ(taken.cloud->all_rows, 500u);
  ASSERT_EQ(taken.cloud->points.size(), 500u);
  EXPECT_EQ(taken.cloud->points[7], Eigen::Vector3f(7.0F, 1.0F, 2.0F));
  EXPECT_EQ(taken.cloud->times[7], 7.0F);
  EXPECT_EQ(taken.cloud->rows[7], 7u);
}

TEST(RawCloudInput, TakesNoTimesWhereNoChannelIsNamed) {
  const auto bytes = message_of(10);
  const RawCloudInput taken = take_raw_cloud(bus::CloudView(bytes), sensor_with(""));
  ASSERT_TRUE(taken.cloud);
  EXPECT_TRUE(taken.cloud->times.empty());
}

TEST(RawCloudInput, ThinsAndKeepsPointTimeAndRowTogether) {
  const auto bytes = message_of(20'000);
  const RawCloudInput taken = take_raw_cloud(bus::CloudView(bytes), sensor_with("time", 1000));
  ASSERT_TRUE(taken.cloud);
  EXPECT_NEAR(static_cast<double>(taken.cloud->points.size()), 1000.0, 10.0);
  EXPECT_EQ(taken.cloud->all_rows, 20'000u);
  for (std::size_t i = 0; i < taken.cloud->points.size(); ++i) {
    const auto row = static_cast<float>(taken.cloud->rows[i]);
    EXPECT_EQ(taken.cloud->points[i].x(), row);
    EXPECT_EQ(taken.cloud->times[i], row);
  }
}

TEST(RawCloudInput, RefusesAMessageWithoutTheChannelAndSaysWhichItHas) {
  const auto bytes = message_of(10);
  const RawCloudInput taken = take_raw_cloud(bus::CloudView(bytes), sensor_with("t"));
  EXPECT_FALSE(taken.cloud);
  EXPECT_THAT(taken.refusal, HasSubstr("LASER_3D has no channel \"t\""));
  EXPECT_THAT(taken.refusal, HasSubstr("it has: intensity, time"));
}

TEST(RawCloudInput, RefusesAChannelThatIsThereTwice) {
  pointcloud_t message{};
  message.n_channels = 2;
  message.channel_names = {"time", "time"};
  message.channels.resize(2);
  std::vector<std::uint8_t> bytes;
  ASSERT_EQ(bus::encode(message, bytes), bus::Fault::kNone);
  EXPECT_THAT(take_raw_cloud(bus::CloudView(bytes), sensor_with("time")).refusal,
              HasSubstr("more than one"));
}

}  // namespace
}  // namespace voxlist::service
