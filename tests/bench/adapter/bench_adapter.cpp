// From the encoded message of a 3D laser to its encoded CLOUD, as cloud_adapter makes it:
// de-skewed, on a robot that drives at 1 m/s and 60 deg/s. One message of so many points; `thinned`
// has the service's default of 30,000 points, `all` takes each.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>
#include <voxlist/pointcloud_t.hpp>

#include "voxlist/adapter/cloud_adapter.h"
#include "voxlist/bus/cloud_view.h"
#include "voxlist/bus/convert.h"
#include "voxlist/service/inputs/raw_cloud_input.h"

namespace voxlist::bench {
namespace {

constexpr std::int64_t kStart_us = 1'700'000'000'000'000;

// One revolution in 0.1 s, 64 rings, with time, ring and intensity.
std::vector<std::uint8_t> sweep_of(int points) {
  pointcloud_t message{};
  message.utime = kStart_us + 500'000;
  message.n_points = points;
  message.n_channels = 3;
  message.channel_names = {"intensity", "ring", "time"};
  message.channels.resize(3);
  for (int i = 0; i < points; ++i) {
    const double share = static_cast<double>(i) / points, azimuth_rad = 6.283185 * share;
    const double range_m = 2.0 + (i * 37 % 200) * 0.1;
    message.points.push_back({static_cast<float>(range_m * std::cos(azimuth_rad)),
                              static_cast<float>(range_m * std::sin(azimuth_rad)),
                              static_cast<float>(i % 64 * 0.05 - 1.5)});
    message.channels[0].push_back(1.0F);
    message.channels[1].push_back(static_cast<float>(i % 64));
    message.channels[2].push_back(static_cast<float>(0.1 * share));
  }
  std::vector<std::uint8_t> bytes;
  bus::encode(message, bytes);
  return bytes;
}

adapter::AdapterConfig config_of(int max_points) {
  adapter::AdapterConfig config;
  config.robot_boxes_m = {-0.4, 0.3, -0.3, 0.3, 0.0, 0.5};
  config.sensors.emplace_back().channel = "LASER_3D";
  config.sensors[0].mount_z_m = 1.0;
  config.sensors[0].mount_pitch_deg = 10.0;
  config.sensors[0].time_channel = "time";
  config.sensors[0].max_points = max_points;
  return config;
}

adapter::CloudAdapter driving(const adapter::AdapterConfig& config) {
  adapter::CloudAdapter adapter(config);
  for (int i = 0; i <= 40; ++i) {
    const double t_s = 0.02 * i, yaw_rad = 1.047 * t_s;
    adapter.add_odometry({kStart_us + i * 20'000,
                          to_pose3(Pose2{std::sin(yaw_rad), 1.0 - std::cos(yaw_rad), yaw_rad})});
  }
  return adapter;
}

void adapt(benchmark::State& state, int max_points) {
  const auto message = sweep_of(static_cast<int>(state.range(0)));
  const adapter::AdapterConfig config = config_of(max_points);
  const adapter::CloudAdapter fresh = driving(config);
  std::size_t points = 0;
  for (auto _ : state) {
    state.PauseTiming();
    adapter::CloudAdapter adapter = fresh;
    state.ResumeTiming();
    auto raw = service::take_raw_cloud(bus::CloudView(message), config.sensors[0]);
    const adapter::Adapted adapted = adapter.add_cloud(0, std::move(*raw.cloud));
    if (adapted.clouds.empty()) return state.SkipWithError("no cloud");
    points = adapted.clouds[0].points.size();
    std::vector<std::uint8_t> bytes;
    bus::encode(bus::to_message(adapted.clouds[0], "base", 0), bytes);
    benchmark::DoNotOptimize(bytes.data());
  }
  state.counters["points"] = static_cast<double>(points);
}

void thinned(benchmark::State& state) { adapt(state, 30'000); }
void all(benchmark::State& state) { adapt(state, 1'000'000); }
BENCHMARK(thinned)->Arg(30'000)->Arg(65'000)->Arg(130'000)->Unit(benchmark::kMillisecond);
BENCHMARK(all)->Arg(30'000)->Arg(65'000)->Arg(130'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace voxlist::bench

BENCHMARK_MAIN();
