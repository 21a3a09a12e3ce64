#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/live/bus_options.h"
#include "services/voxlist/live/playback.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/stop.h"

namespace voxlist::desk {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::microseconds, std::chrono::milliseconds;

// The player waits for the listeners while more than this (bytes) is to be sent.
constexpr std::int64_t kAhead = 8'000'000;

// It looks this often at whether it is to stop.
constexpr milliseconds kLook(50);

struct PlayOptions {
  std::vector<std::filesystem::path> logs;
  std::string config, url, only = ".*";
  double speed = 1.0;
};

void wait_until(bus::Bus& bus, Clock::time_point time) {
  for (auto left = time - Clock::now(); left >= milliseconds(1) && !stop_requested();
       left = time - Clock::now())
    bus.handle(std::min(kLook, std::chrono::duration_cast<milliseconds>(left)));
}

void wait_for_listeners(bus::Bus& bus) {
  while (bus.traffic().queued_bytes > kAhead && !stop_requested()) bus.handle(milliseconds(1));
}

int play(const PlayOptions& options, Console& console) {
  Playback playback(options.logs, options.only, options.speed);
  bus::BusOptions bus_options = read_bus_options(options.config, options.url);
  bus_options.prefix.clear();  // recorded channels have it
  bus::Bus bus(bus_options);
  stop_on_interrupt();
  const auto start = Clock::now();
  std::int64_t messages = 0;
  while (const auto due = playback.next()) {
    wait_until(bus, start + microseconds(due->after_us));
    wait_for_listeners(bus);
    if (stop_requested()) break;
    bus.publish_encoded(due->event.channel, due->event.bytes);
    ++messages;
  }
  console.warn(fmt::format("{} messages played", messages));
  return bus.losses().empty() ? 0 : 1;
}

}  // namespace

void add_play(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "play", "Sends the messages of a recording at their times; large ones arrive, too.");
  const auto options = std::make_shared<PlayOptions>();
  command->add_option("logs", options->logs, "the files of the recording, in their order")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--only", options->only, "regular expression of the channels; default all");
  command->add_option("--speed", options->speed, "times as fast as it was recorded")
      ->check(CLI::Range(1e-6, 1e6));
  command->add_option("--config", options->config, "the robot's settings, for its table [bus]")
      ->check(CLI::ExistingFile);
  command->add_option("--lcm-url", options->url,
                      "the bus; default $LCM_DEFAULT_URL, else that of --config, else LCM's");
  command->footer("Example:\n  voxlist play hall.lcm.00 hall.lcm.01 --only '^(CLOUD|ODOMETRY)$'");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return play(*options, console); };
  });
}

}  // namespace voxlist::desk
