#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <vector>
#include <voxlist/health_t.hpp>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/obstacles_t.hpp>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/live/bus_options.h"
#include "services/voxlist/live/health_board.h"
#include "services/voxlist/live/robot_view.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/stop.h"

namespace voxlist::desk {
namespace {

// A terminal shows one line that is drawn anew; a log or a pipe gets a line now and then, so that
// a drive of two minutes stays readable.
constexpr double kRedraw_s = 1.0, kLine_s = 20.0;

struct WatchOptions {
  std::string config, url;
  double seconds = 0.0;
  double idle_seconds = 0.0;
};

double now_s() {
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

void listen(bus::Bus& bus, RobotView& robot, HealthBoard& services) {
  bus.subscribe(bus::kLocalisation,
                [&robot](const localisation_t& message) { robot.take(message, now_s()); });
  bus.subscribe(bus::kKeyframe,
                [&robot](const keyframe_t& message) { robot.take(message, now_s()); });
  bus.subscribe(
      bus::kObstacles, [&robot](const obstacles_t& message) { robot.take(message, now_s()); },
      bus::Delivery::kLatest);
  bus.subscribe(bus::kHealth,
                [&services](const health_t& message) { services.take(message, now_s()); });
}

bool is_over(const WatchOptions& options, const RobotView& robot, double start_s) {
  if (stop_requested()) return true;
  if (options.seconds > 0.0 && now_s() - start_s >= options.seconds) return true;
  return options.idle_seconds > 0.0 && robot.seen() &&
         now_s() - robot.last_seen_s() >= options.idle_seconds;
}

int run(const WatchOptions& options, Console& console) {
  bus::Bus bus(read_bus_options(options.config, options.url));
  RobotView robot;
  HealthBoard services;
  listen(bus, robot, services);
  stop_on_interrupt();
  const double start_s = now_s();
  double next_s = start_s;
  while (!is_over(options, robot, start_s) && bus.handle(std::chrono::milliseconds(100))) {
    if (now_s() < next_s) continue;
    next_s += console.terminal() ? kRedraw_s : kLine_s;
    std::vector<std::string> lines = robot.lines(now_s());
    for (const std::string& trouble : services.troubles(now_s())) lines.push_back("  " + trouble);
    console.show(lines);
  }
  console.erase();
  console.say(robot.summary());
  return robot.seen() ? 0 : 1;
}

}  // namespace

void add_watch(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "watch", "Shows where the robot is, how its map grows, and what is wrong, live.");
  const auto options = std::make_shared<WatchOptions>();
  command->add_option("--config", options->config, "the robot's settings, for its table [bus]")
      ->check(CLI::ExistingFile);
  command->add_option("--lcm-url", options->url,
                      "the bus; default $LCM_DEFAULT_URL, else that of --config, else LCM's");
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
