#include "voxlist/bus/cloud_view.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <vector>
#include <voxlist/pointcloud_t.hpp>

#include "voxlist/bus/bus.h"

namespace voxlist::bus {
namespace {

using testing::ElementsAre;

pointcloud_t sample() {
  pointcloud_t message{};
  message.utime = 1'700'000'000'123'456;
  message.seq = -7;
  message.frame_id = "laser";
  message.n_points = 3;
  message.points = {{1.0F, -2.0F, 3.5F}, {4.0F, 5.0F, -0.0F}, {NAN, INFINITY, 1e-40F}};
  message.n_channels = 2;
  message.channel_names = {"intensity", "t"};
  message.channels = {{0.1F, 0.2F, 0.3F}, {-1.0F, 0.0F, 3e38F}};
  return message;
}

std::vector<std::uint8_t> bytes_of(const pointcloud_t& message) {
  std::vector<std::uint8_t> bytes;
  EXPECT_EQ(encode(message, bytes), Fault::kNone);
  return bytes;
}

TEST(CloudView, ReadsWhatTheDecoderReads) {
  const pointcloud_t message = sample();
  const auto bytes = bytes_of(message);
  const CloudView view(bytes);
  EXPECT_EQ(view.utime_us(), message.utime);
  EXPECT_EQ(view.seq(), -7);
  EXPECT_THAT(view.channel_names(), ElementsAre("intensity", "t"));
  ASSERT_EQ(view.size(), 3u);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_EQ(view.point(i)[static_cast<Eigen::Index>(axis)], message.points[i][axis]);
  EXPECT_TRUE(std::isnan(view.point(2).x()));
  EXPECT_EQ(view.point(2).z(), 1e-40F);
  for (std::size_t channel = 0; channel < 2; ++channel)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(view.value(channel, i), message.channels[channel][i]);
}

TEST(CloudView, OfAnEmptyCloudIsEmpty) {
  const auto bytes = bytes_of(pointcloud_t{});
  const CloudView view(bytes);
  EXPECT_EQ(view.size(), 0u);
  EXPECT_TRUE(view.channel_names().empty());
}

TEST(Bus, HandsOutTheBytesOfAWholeMessageAndCountsOthers) {
  Bus bus({.url = "memq://", .prefix = ""});
  std::vector<std::int64_t> utimes;
  bus.subscribe_bytes(kCloud, [&](Bytes bytes) { utimes.push_back(CloudView(bytes).utime_us()); });
  auto bytes = bytes_of(sample());
  bus.publish_encoded("CLOUD", bytes);
  bytes.pop_back();
  bus.publish_encoded("CLOUD", bytes);
  for (int i = 0; i < 3; ++i) bus.handle(std::chrono::milliseconds(0));
  EXPECT_THAT(utimes, ElementsAre(sample().utime));
  EXPECT_EQ(bus.counters().at("CLOUD/handled"), 1);
  EXPECT_EQ(bus.counters().at("CLOUD/truncated"), 1);
}

}  // namespace
}  // namespace voxlist::bus
