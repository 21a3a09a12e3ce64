#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/obstacles_t.hpp>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/bus/bus.h"
#include "voxlist/matching/localisation/localisation.h"

namespace voxlist::desk {
namespace {

using Clock = std::chrono::steady_clock;

struct WatchOptions {
  std::string url;
  double seconds = 0.0;
  double idle_seconds = 0.0;
};

// What is known of the robot from the bus.
class RobotView {
 public:
  explicit RobotView(bus::Bus& bus) {
    bus.subscribe(bus::kLocalisation, [this](const localisation_t& message) { take(message); });
    bus.subscribe(bus::kKeyframe,
                  [this](const keyframe_t& message) { keyframes_ = message.index + 1; });
    bus.subscribe(
        bus::kObstacles, [this](const obstacles_t& message) { take(message); },
        bus::Delivery::kLatest);
  }

  bool seen() const { return localisations_ > 0; }
  Clock::time_point last_seen() const { return last_seen_; }

  std::string line() const {
    if (!seen())
      return "waiting for LOCALISATION: are the services running, and does a scanner publish "
             "CLOUD?";
    const double time_s = static_cast<double>(last_.utime - first_utime_us_) * 1e-6;
    std::string text = fmt::format("{:5.0f} s  {:9}", time_s,
                                   name(static_cast<matching::LocalisationState>(last_.state)));
    if (!last_.modes.empty()) {
      const double* pose = last_.modes.front().pose;
      text += fmt::format("  x {:7.2f} m  y {:7.2f} m  yaw {:6.1f} deg", pose[0], pose[1],
                          pose[2] * 180.0 / std::numbers::pi);
    }
    text += fmt::format("  map {:4} keyframes", keyframes_);
    if (std::isfinite(nearest_m_)) text += fmt::format("  nearest obstacle {:.2f} m", nearest_m_);
    return text;
  }

  std::string summary() const {
    return fmt::format("{} clouds, {} placed, map of {} keyframes", localisations_, tracking_,
                       keyframes_);
  }

 private:
  void take(const localisation_t& message) {
    if (!seen()) first_utime_us_ = message.utime;
    ++localisations_;
    tracking_ += message.state == localisation_t::STATE_TRACKING;
    last_ = message;
    last_seen_ = Clock::now();
  }

  void take(const obstacles_t& message) {
    nearest_m_ = std::numeric_limits<float>::infinity();
    for (const float range : message.ranges_m) nearest_m_ = std::min(nearest_m_, range);
  }

  localisation_t last_{};
  Clock::time_point last_seen_;
  std::int64_t first_utime_us_ = 0;
  int localisations_ = 0, tracking_ = 0, keyframes_ = 0;
  float nearest_m_ = std::numeric_limits<float>::infinity();
};

bool is_over(const WatchOptions& options, const RobotView& robot, Clock::time_point start) {
  const auto seconds_since = [](Clock::time_point time) {
    return std::chrono::duration<double>(Clock::now() - time).count();
  };
  if (stop_requested()) return true;
  if (options.seconds > 0.0 && seconds_since(start) >= options.seconds) return true;
  return options.idle_seconds > 0.0 && robot.seen() &&
         seconds_since(robot.last_seen()) >= options.idle_seconds;
}

int run(const WatchOptions& options, Console& console) {
  bus::BusOptions bus_options;
  const char* environment = std::getenv("LCM_DEFAULT_URL");
  if (environment) bus_options.url = environment;
  if (!options.url.empty()) bus_options.url = options.url;
  bus::Bus bus(bus_options);
  RobotView robot(bus);
  stop_on_interrupt();
  const auto start = Clock::now();
  auto next_line = start;
  while (!is_over(options, robot, start) && bus.handle(std::chrono::milliseconds(100))) {
    if (Clock::now() < next_line) continue;
    next_line += std::chrono::seconds(console.terminal() ? 1 : 5);
    if (console.terminal()) {
      console.draw(robot.line());
    } else {
      console.warn(robot.line());
    }
  }
  console.erase();
  console.say(robot.summary());
  return robot.seen() ? 0 : 1;
}

}  // namespace

void add_watch(CLI::App& program, Command& chosen) {
  CLI::App* command =
      program.add_subcommand("watch", "Shows where the robot is and how its map grows, live.");
  const auto options = std::make_shared<WatchOptions>();
  command->add_option("--lcm-url", options->url,
                      "the bus; default $LCM_DEFAULT_URL, else LCM's default");
  command->add_option("--seconds", options->seconds, "ends after this time; default: at Ctrl-C")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--idle", options->idle_seconds, "ends when no cloud was answered for this long")
      ->check(CLI::NonNegativeNumber);
  command->footer("Example:\n  voxlist watch --seconds 60");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return run(*options, console); };
  });
}

}  // namespace voxlist::desk
