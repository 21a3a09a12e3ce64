// What 3D lasers say at 10 Hz, from their driver by way of cloud_adapter and localiser to POSE,
// with driver, cloud_adapter, localiser and mapper all on the machine's first core: how many clouds
// are answered and how late, how exact their poses are, and what each process costs. It makes a
// private network for itself.
#include <fmt/core.h>
#include <sched.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <thread>
#include <voxlist/health_t.hpp>
#include <voxlist/localisation_t.hpp>

#include "tests/bench/adapter/child.h"
#include "tests/bench/adapter/stream.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/bus.h"

namespace {

using namespace voxlist;
using namespace voxlist::bench;

constexpr int kCore = 0;

struct Options {
  double seconds = 20.0;
  std::uint64_t seed = 1;
  int points = 0;  // 0: as the kinds have
  double rate_hz = 10.0;
  int busy = 0;
  std::string only;
  bool shows_health = false, lists = false;
};

std::int64_t now_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

void sleep_until_us(std::int64_t utime_us) {
  std::this_thread::sleep_for(std::chrono::microseconds(utime_us - now_us()));
}

// Each sweep as it ends, each step of the wheels when it is measured.
void publish(const Stream& stream, double sweep_s, std::int64_t start_us) {
  bus::Bus bus({});
  const auto sweep_us = std::llround(sweep_s * 1e6);
  auto step = stream.odometry.begin();
  for (pointcloud_t cloud : stream.clouds) {
    const std::int64_t due_us = start_us + cloud.utime + sweep_us;
    for (; step != stream.odometry.end() && start_us + step->utime <= due_us; ++step) {
      sleep_until_us(start_us + step->utime);
      pose_t odometry = *step;
      odometry.utime += start_us;
      bus.publish(bus::kOdometry, odometry);
    }
    sleep_until_us(due_us);
    cloud.utime += start_us;
    bus.publish(bus::Channel<pointcloud_t>{kLaserChannel}, cloud, bus::Delivery::kLatest);
  }
  for (; step != stream.odometry.end(); ++step) {
    sleep_until_us(start_us + step->utime);
    pose_t odometry = *step;
    odometry.utime += start_us;
    bus.publish(bus::kOdometry, odometry);
  }
}

void want_all() {
  for (volatile unsigned n = 0;;) n = n + 1;
}

struct Answer {
  localisation_t message;
  std::int64_t arrival_us;
};

// What the listener hears.
struct Heard {
  std::vector<Answer> answers;
  std::map<std::string, health_t> health;  // the last of each service
};

class Listener {
 public:
  Listener() {
    bus_.subscribe(bus::kLocalisation, [this](const localisation_t& m) {
      heard_.answers.push_back({m, now_us()});
    });
    bus_.subscribe(bus::kHealth, [this](const health_t& m) { heard_.health[m.service] = m; });
  }

  void listen_until(std::int64_t utime_us) {
    while (now_us() < utime_us) bus_.handle(std::chrono::milliseconds(20));
  }

  bool wait_for(const std::vector<std::string>& services) {
    const std::int64_t give_up_us = now_us() + 20'000'000;
    const auto is_there = [this](const std::string& s) { return heard_.health.contains(s); };
    while (now_us() < give_up_us && !std::ranges::all_of(services, is_there))
      bus_.handle(std::chrono::milliseconds(20));
    return std::ranges::all_of(services, is_there);
  }

  const Heard& heard() const { return heard_; }

 private:
  bus::Bus bus_{bus::BusOptions{}};
  Heard heard_;
};

template <class T>
double percentile(std::vector<T> values, double percent) {
  if (values.empty()) return NAN;
  std::ranges::sort(values);
  return static_cast<double>(
      values[static_cast<std::size_t>(static_cast<double>(values.size() - 1) * percent / 100.0)]);
}

Pose2 pose_of(const localisation_t& message) {
  const double* pose = message.modes.front().pose;
  return {pose[0], pose[1], pose[2]};
}

// How far each pose is off, as it lies to the first one.
std::vector<double> errors_mm(const std::vector<Answer>& answers, const Stream& stream,
                              std::int64_t start_us, bool lists) {
  std::vector<double> errors;
  std::optional<Pose2> T_map_building;
  for (const auto& [message, arrival_us] : answers) {
    if (message.state != localisation_t::STATE_TRACKING) continue;
    const Pose2 truth = stream.drive.at(static_cast<double>(message.utime - start_us) * 1e-6);
    if (!T_map_building) T_map_building = pose_of(message) * truth.inverse();
    errors.push_back(1000.0 * distance_m(pose_of(message), *T_map_building * truth));
    if (lists)
      fmt::print("  {:.1f} {} {:.0f}\n", static_cast<double>(message.utime - start_us) * 1e-6,
                 message.searched_whole_map, errors.back());
  }
  return errors;
}

void print(const StreamKind& kind, const Stream& stream, const Heard& heard, std::int64_t start_us,
           const std::map<std::string, double>& cpu_s, const Options& options) {
  std::vector<double> late_ms;
  const auto sweep_us = std::llround(kind.laser.sweep_s * 1e6);
  for (const auto& [message, arrival_us] : heard.answers) {
    // A cloud is of its last point: its sweep ends with the next period.
    const std::int64_t after_us = message.utime - start_us;
    const std::int64_t due_us = start_us + (after_us / sweep_us + 1) * sweep_us;
    late_ms.push_back(static_cast<double>(arrival_us - due_us) * 1e-3);
  }
  const std::vector<double> errors = errors_mm(heard.answers, stream, start_us, options.lists);
  const auto wrong = std::ranges::count_if(errors, [](double mm) { return mm > 100.0; });
  fmt::print("| {} | {} | {} of {} | {} | {} | {:.1f} | {:.1f} | {:.0f} | {:.0f} | {:.0f} |",
             kind.name, kind.laser.rays, heard.answers.size(), stream.clouds.size(), errors.size(),
             wrong, percentile(errors, 50), percentile(errors, 99), percentile(late_ms, 50),
             percentile(late_ms, 99), percentile(late_ms, 100));
  for (const char* name : {"driver", "cloud_adapter", "localiser", "mapper"})
    fmt::print(" {:.0f} |", 100.0 * cpu_s.at(name) / options.seconds);
  fmt::print("\n");
}

void print_health(const Heard& heard) {
  for (const auto& [name, health] : heard.health) {
    fmt::print("  {}: {}\n   ", name, health.message);
    for (const counter_t& counter : health.counters)
      fmt::print(" {}={}", counter.name, counter.count);
    fmt::print("\n");
  }
}

bool measure(const StreamKind& kind, const Options& options) {
  const Stream stream = make_stream(kind, options.seconds, options.seed);
  const test::TemporaryFolder work;
  const std::string settings = work.write("robot.toml", settings_of(kind));
  std::map<std::string, Child> children;
  std::vector<Child> busy;
  for (int i = 0; i < options.busy; ++i) busy.emplace_back(want_all, kCore);
  const std::vector<std::string> services{"mapper", "localiser", "cloud_adapter"};
  for (const std::string& name : services)
    children.emplace(
        name, Child({std::string(VOXLIST_BIN_DIR) + "/" + name, "--config", settings}, kCore));
  const std::int64_t start_us = now_us() + 3'000'000;
  children.emplace("driver", Child([&] { publish(stream, kind.laser.sweep_s, start_us); }, kCore));
  Listener listener;
  if (!listener.wait_for(services)) return fmt::print("the services do not start\n"), false;
  listener.listen_until(start_us + std::llround((options.seconds + 2.5) * 1e6));
  std::map<std::string, double> cpu_s;
  for (auto& [name, child] : children) cpu_s[name] = name == "driver" ? child.wait() : child.end();
  print(kind, stream, listener.heard(), start_us, cpu_s, options);
  if (options.shows_health) print_health(listener.heard());
  return !listener.heard().answers.empty();
}

bool enter_private_network() {
  if (unshare(CLONE_NEWNET) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
  return std::system("ip link set lo up && ip route add 224.0.0.0/4 dev lo") == 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App program{"Streams of simulated 3D lasers at 10 Hz, to POSE on one core."};
  program.add_option("--seconds", options.seconds, "of each drive");
  program.add_option("--seed", options.seed, "of the building, the wheels and the noise");
  program.add_option("--points", options.points, "of a sweep, instead of each laser's own");
  program.add_option("--rate", options.rate_hz, "sweeps a second");
  program.add_option("--busy", options.busy, "processes that want all of the same core");
  program.add_option("--only", options.only, "lasers in whose names this is found");
  program.add_flag("--list", options.lists,
                   "each pose: s, whether the whole map was searched, how far it is off in mm");
  program.add_flag("--health", options.shows_health, "what the services counted");
  CLI11_PARSE(program, argc, argv);
  if (!enter_private_network()) {
    fmt::print("no private network here: this user may not make namespaces\n");
    return 0;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  leave_core(kCore);
  fmt::print(
      "| laser | rays | answered | TRACKING | off by > 0.1 m | error, median (mm) | p99 | "
      "late, median (ms) | p99 | most | driver (% of the core) | cloud_adapter | localiser "
      "| mapper |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (StreamKind kind : stream_kinds()) {
    if (kind.name.find(options.only) == std::string::npos) continue;
    if (options.points > 0) kind.laser.rays = options.points;
    kind.laser.sweep_s = 1.0 / options.rate_hz;
    if (!measure(kind, options)) return 1;
  }
  return 0;
}
