#include <fmt/core.h>
#include <poll.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/commands/settings.h"
#include "services/voxlist/maps/stored_map.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/stop.h"
#include "services/voxlist/view/player.h"

namespace voxlist::desk {
namespace {

struct ViewOptions {
  std::filesystem::path input, config;
  std::uint16_t port = 7669;
  std::vector<std::string> robots{"robot"};
  viewing::ViewerConfig viewer;
  PrefixOption prefix;
};

// How long the player waits between its ticks: a page is at most this late.
constexpr int kTick_ms = 10;

std::int64_t steady_us() {
  using namespace std::chrono;
  return duration_cast<microseconds>(steady_clock::now().time_since_epoch()).count();
}

std::unique_ptr<Events> open(const ViewOptions& options, Console& console) {
  if (!std::filesystem::is_directory(options.input))
    return std::make_unique<LogEvents>(options.input, options.prefix.of(options.config));
  mapping::MapBuilderConfig config = read_settings(options.config).mapper;
  config.count_free = true;
  const StoredMap map = read_map(options.input, config, console);
  return std::make_unique<MapEvents>(map.builder.map(), map.builder.free_space(),
                                     trajectory_of(options.input, map.poses));
}

void warn_without_map(const Highlights& found, Console& console) {
  if (!found.has_map)
    console.warn(
        "the recording has no map (scripts/record --inputs makes such): `voxlist map` makes one");
}

int view(const ViewOptions& options, Console& console) {
  auto events = open(options, console);
  const Highlights found = highlights_of(*events);
  if (found.end_us == 0) throw std::runtime_error(options.input.string() + ": nothing is recorded");
  warn_without_map(found, console);
  Player player(std::move(events), found, options.input.filename(), options.viewer,
                {.port = options.port}, options.robots);
  console.say(fmt::format("http://127.0.0.1:{}/ shows it; Ctrl-C ends it", player.port()));
  while (!stop_requested()) {
    player.tick(steady_us());
    poll(nullptr, 0, kTick_ms);
  }
  return 0;
}

}  // namespace

void add_view(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "view", "Serves a page that shows a recording or a map, with a time bar.");
  const auto options = std::make_shared<ViewOptions>();
  command->add_option("LOG|MAPDIR", options->input, "a recording, or a map folder")
      ->required()
      ->check(CLI::ExistingPath);
  command->add_option("--port", options->port, "of 127.0.0.1; 0: any that is free")
      ->capture_default_str();
  command->add_option("--robot", options->robots, "whose floor plans are shown")
      ->capture_default_str();
  command->add_option("--detail", options->viewer.detail_m, "edge of the voxels (m), at least")
      ->check(CLI::Range(0.04, 1.0))
      ->capture_default_str();
  command->add_option("--config", options->config, "robot.toml, for [mapper] and the prefix")
      ->check(CLI::ExistingFile);
  options->prefix.add_to(*command);
  command->footer("Example:\n  voxlist view office.lcm\n  voxlist view office_map");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return view(*options, console); };
  });
}

}  // namespace voxlist::desk
