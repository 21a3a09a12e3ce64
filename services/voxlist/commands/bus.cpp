#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/commands/settings.h"
#include "services/voxlist/live/bus_options.h"
#include "services/voxlist/output/console.h"

namespace voxlist::desk {
namespace {

struct Options {
  std::filesystem::path config;
};

int tell(const Options& options, Console& console) {
  const bus::BusOptions bus = read_bus_options(options.config, "");
  console.say("url " + bus.url);
  console.say("prefix " + bus.prefix);
  for (const auto& sensor : read_adapter_settings(options.config).sensors)
    console.say("laser " + sensor.channel);
  return 0;
}

}  // namespace

void add_bus(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "bus",
      "Tells the url of the robot's bus, the prefix of its channels, and those of its lasers.");
  const auto options = std::make_shared<Options>();
  command->add_option("--config", options->config,
                      "the robot's settings, for its tables [bus] and [cloud_adapter]");
  command->footer(
      "Example:\n"
      "  voxlist bus --config services/robot.toml");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return tell(*options, console); };
  });
}

}  // namespace voxlist::desk
