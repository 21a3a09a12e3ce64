#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <vector>
#include <voxlist/health_t.hpp>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/live/bus_options.h"
#include "services/voxlist/live/health_board.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/stop.h"

namespace voxlist::desk {
namespace {

// Services speak once a second; a little more, for a machine that is busy.
constexpr double kPatience_s = 2.5;

// As `systemctl status` and `scripts/services status` do when something is not as it should be.
constexpr int kNotWell = 3;

struct HealthOptions {
  std::string config, url;
  std::vector<std::string> services;
  bool once = false;
};

double now_s() {
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

// Until all that are expected were heard, or it is long enough.
void hear_once(bus::Bus& bus, const HealthOptions& options, const HealthBoard& board) {
  const double end_s = now_s() + kPatience_s;
  const auto heard = [&] { return !options.services.empty() && board.all_heard(); };
  while (!heard() && now_s() < end_s && !stop_requested())
    bus.handle(std::chrono::milliseconds(50));
}

void show_until_stopped(bus::Bus& bus, const HealthBoard& board, Console& console) {
  double next_s = now_s();
  while (!stop_requested() && bus.handle(std::chrono::milliseconds(100))) {
    if (now_s() < next_s) continue;
    next_s += 1.0;
    console.show(board.table(now_s()));
  }
  console.erase();
}

int run(const HealthOptions& options, Console& console) {
  bus::Bus bus(read_bus_options(options.config, options.url));
  HealthBoard board(options.services);
  bus.subscribe(bus::kHealth, [&board](const health_t& message) { board.take(message, now_s()); });
  stop_on_interrupt();
  if (options.once || !console.terminal()) {
    hear_once(bus, options, board);
  } else {
    show_until_stopped(bus, board, console);
  }
  for (const std::string& line : board.table(now_s())) console.say(line);
  return board.is_well(now_s()) ? 0 : kNotWell;
}

}  // namespace

void add_health(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "health", "Shows how each service fares and why, live; exit code 3 when one is in error.");
  const auto options = std::make_shared<HealthOptions>();
  command->add_option("services", options->services,
                      "services that must be there; default: those that are heard");
  command->add_option("--config", options->config, "the robot's settings, for its table [bus]")
      ->check(CLI::ExistingFile);
  command->add_option("--lcm-url", options->url,
                      "the bus; default $LCM_DEFAULT_URL, else that of --config, else LCM's");
  command->add_flag("--once", options->once,
                    "tells how they fare now, and ends; so it does without a terminal");
  command->footer("Example:\n  voxlist health --config services/robot.toml");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return run(*options, console); };
  });
}

}  // namespace voxlist::desk
