#include "tests/bench/delivery/sender.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <optional>
#include <thread>
#include <voxlist/pointcloud_t.hpp>

#include "voxlist/bus/bus.h"

namespace voxlist::bench {
namespace {

using Clock = std::chrono::steady_clock;

pointcloud_t cloud_of(std::size_t points, bool with_origins) {
  pointcloud_t cloud{};
  cloud.frame_id = "base";
  cloud.n_points = static_cast<std::int32_t>(points);
  cloud.points.assign(points, {1.0F, 2.0F, 3.0F});
  if (with_origins) cloud.channel_names = {"origin_x", "origin_y", "origin_z"};
  cloud.n_channels = static_cast<std::int32_t>(cloud.channel_names.size());
  cloud.channels.assign(cloud.channel_names.size(), std::vector<float>(points));
  return cloud;
}

double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

double processor_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

// One of the two ways.
std::function<void(const pointcloud_t&)> open_sender(const Sending& sending) {
  if (sending.sender == Sending::Sender::kBus) {
    auto bus = std::make_shared<bus::Bus>(bus::BusOptions{});
    return [bus](const pointcloud_t& cloud) { bus->publish(bus::kCloud, cloud); };
  }
  auto lcm = std::make_shared<lcm::LCM>("udpm://239.255.76.67:7667?ttl=0");
  return [lcm](const pointcloud_t& cloud) { lcm->publish("CLOUD", &cloud); };
}

std::int64_t wall_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

}  // namespace

Sent send_clouds(const Sending& sending) {
  pointcloud_t cloud = cloud_of(sending.points, sending.with_origins);
  Sent sent;
  sent.bytes = static_cast<std::size_t>(cloud.getEncodedSize());
  const double processor_start = processor_seconds();
  const auto start = Clock::now();
  {
    const auto send = open_sender(sending);
    for (int i = 0; i < sending.clouds; ++i) {
      std::this_thread::sleep_until(start + std::chrono::duration<double>(i / sending.rate_hz));
      cloud.utime = wall_us();
      cloud.seq = i;
      const auto call = Clock::now();
      send(cloud);
      sent.longest_call_ms = std::max(sent.longest_call_ms, 1000 * seconds(Clock::now() - call));
    }
  }
  sent.processor_share = (processor_seconds() - processor_start) / seconds(Clock::now() - start);
  return sent;
}

}  // namespace voxlist::bench
