// How soon a cloud is there after its last line: in the assembler alone, and over the bus through
// the service. Over memq, unless VOXLIST_BENCH_URL names a network (README.md).
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <optional>
#include <thread>
#include <vector>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/cloud_assembler/cloud_assembler_service.h"
#include "tests/bench/report.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/scanner/sweep/cloud_assembler.h"

namespace voxlist::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::int64_t kStart_us = 1'700'000'000'000'000;
constexpr int kLinesPerSweep = 75;
constexpr int kWarmUpLines = 2 * kLinesPerSweep;

// Faster than a scanner, and slow enough for each message to be alone on its way.
constexpr std::chrono::milliseconds kPace(4);

std::int64_t line_utime_us(std::int64_t index) {
  return kStart_us + std::llround(static_cast<double>(index) * kLaserTurn_us);
}

// 181 beams, each of which becomes a point unless it is blind or past the mirror: 9,000 a sweep.
LaserLine line(std::int64_t index) {
  LaserLine line;
  line.utime_us = line_utime_us(index);
  line.ranges_m.assign(181, 4.0F);
  return line;
}

// Half a turn a second.
MirrorState mirror(std::int64_t index) {
  MirrorState state;
  state.utime_us = line_utime_us(index);
  state.state = MirrorState::State::kLocked;
  state.angle_known = true;
  const double turn_rad = 2.0 * std::numbers::pi;
  const double angle_rad =
      std::numbers::pi * static_cast<double>(state.utime_us - kStart_us) * 1e-6;
  state.angle_rad = std::fmod(angle_rad, turn_rad);
  state.rate_radps = std::numbers::pi;
  return state;
}

// 0.5 m/s and 45 deg/s.
StampedPose2 odometry(std::int64_t index) {
  const std::int64_t utime_us = line_utime_us(index);
  const double yaw_rad = std::numbers::pi / 4.0 * static_cast<double>(utime_us - kStart_us) * 1e-6;
  return {utime_us, {std::sin(yaw_rad), 1.0 - std::cos(yaw_rad), wrap_angle(yaw_rad)}};
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void report_latencies(benchmark::State& state, std::vector<double> latencies_s) {
  if (latencies_s.empty()) return state.SkipWithError("nothing came out");
  std::ranges::sort(latencies_s);
  const auto ms = [&latencies_s](double share) {
    const double last = static_cast<double>(latencies_s.size() - 1);
    return 1e3 * latencies_s[static_cast<std::size_t>(std::llround(share * last))];
  };
  state.counters["n"] = static_cast<double>(latencies_s.size());
  state.counters["p50_ms"] = ms(0.5);
  state.counters["p99_ms"] = ms(0.99);
  state.counters["max_ms"] = ms(1.0);
}

void run_assembler(benchmark::State& state) {
  scanner::CloudAssembler assembler({});
  std::int64_t index = 0;
  std::vector<double> latencies_s;
  const auto add_line = [&] {
    assembler.add_odometry(odometry(index));
    assembler.add_mirror(mirror(index));
    LaserLine next = line(index++);
    const auto start = Clock::now();
    const scanner::Assembly made = assembler.add_line(std::move(next));
    if (!made.clouds.empty()) latencies_s.push_back(seconds_since(start));
  };
  for (int i = 0; i < kWarmUpLines; ++i) add_line();
  latencies_s.clear();
  for (auto _ : state)
    for (int i = 0; i < kLinesPerSweep; ++i) add_line();
  state.SetItemsProcessed(state.iterations() * kLinesPerSweep);
  report_latencies(state, latencies_s);
}

// The service: on the given bus, or over a network with a bus and a thread of its own.
class Served {
 public:
  Served(bus::Bus& bus, const std::string& url) {
    if (url.starts_with("memq")) {
      service_.emplace(bus, health_, scanner::CloudAssemblerConfig{});
      return;
    }
    own_bus_.emplace(bus::BusOptions{.url = url, .prefix = ""});
    service_.emplace(*own_bus_, health_, scanner::CloudAssemblerConfig{});
    thread_ = std::thread([this] {
      while (!stop_) own_bus_->handle(std::chrono::milliseconds(20));
    });
  }
  ~Served() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  bus::Health health_{"cloud_assembler"};
  std::optional<bus::Bus> own_bus_;
  std::optional<services::CloudAssemblerService> service_;
  std::thread thread_;
  std::atomic<bool> stop_ = false;
};

// Plays sensors on a bus, and takes the time from a line to what it completes.
class Stopwatch {
 public:
  explicit Stopwatch(const std::string& url)
      : bus_({.url = url, .prefix = ""}),
        pace_(url.starts_with("memq") ? std::chrono::milliseconds(0) : kPace),
        served_(bus_, url) {
    bus_.subscribe(bus::kCloud, [this](const pointcloud_t& m) { note(m, clouds_s); });
    bus_.subscribe(bus::kCloudSlice, [this](const pointcloud_t& m) { note(m, slices_s); });
  }

  void play(int lines) {
    for (int i = 0; i < lines; ++i, ++index_) {
      bus_.publish(bus::kOdometry, bus::to_message(odometry(index_)));
      const planar_lidar_t message = bus::to_message(line(index_));
      sent_[line_utime_us(index_) + std::llround(kLaserTurn_us / 2.0)] = Clock::now();
      bus_.publish(bus::kLaser, message);
      bus_.publish(bus::kMirror, bus::to_message(mirror(index_)));
      const auto until = Clock::now() + pace_;
      do {
        bus_.handle(std::chrono::milliseconds(pace_.count() > 0 ? 1 : 0));
      } while (Clock::now() < until);
    }
  }

  std::vector<double> clouds_s, slices_s;

 private:
  // What a line completes has the time of the line's last beam.
  void note(const pointcloud_t& message, std::vector<double>& latencies_s) {
    const auto sent = sent_.find(message.utime);
    if (sent != sent_.end()) latencies_s.push_back(seconds_since(sent->second));
  }

  bus::Bus bus_;
  std::chrono::milliseconds pace_;
  std::map<std::int64_t, Clock::time_point> sent_;
  std::int64_t index_ = 0;
  Served served_;
};

std::string url() {
  const char* name = std::getenv("VOXLIST_BENCH_URL");
  return name == nullptr ? "memq://" : name;
}

void run_service(benchmark::State& state, std::vector<double> Stopwatch::*latencies_s) {
  Stopwatch stopwatch(url());
  stopwatch.play(kWarmUpLines);
  (stopwatch.*latencies_s).clear();
  for (auto _ : state) stopwatch.play(kLinesPerSweep);
  report_latencies(state, stopwatch.*latencies_s);
}

void run_cloud(benchmark::State& state) { run_service(state, &Stopwatch::clouds_s); }
void run_slice(benchmark::State& state) { run_service(state, &Stopwatch::slices_s); }

void add() {
  const auto named = [](const char* name, void (*function)(benchmark::State&)) {
    return benchmark::RegisterBenchmark(name, function)->Unit(benchmark::kMillisecond);
  };
  named("assembler/last_line_to_cloud", run_assembler);
  named("service/last_line_to_cloud", run_cloud)->UseRealTime();
  named("service/last_line_to_slice", run_slice)->UseRealTime();
}

// What a planner may count on.
void compare(Report& report) {
  report.ratio_to(10.0, "required", "service/last_line_to_cloud", "p99_ms");
  report.ratio_to(5.0, "required", "service/last_line_to_slice", "p99_ms");
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  return voxlist::bench::run_benchmarks(argc, argv, voxlist::bench::add, voxlist::bench::compare);
}
