#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/live/bus_options.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/stop.h"

namespace voxlist::desk {
namespace {

// The mapper answers within milliseconds; a packet may be lost.
constexpr int kTries = 8;
constexpr std::chrono::milliseconds kWait{250};

struct LocaliseOnlyOptions {
  std::string config, url, wanted;
};

map_request_t request_for(const std::string& wanted) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  map_request_t request{};
  request.utime = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
  request.want = map_request_t::WANT_EXTEND;
  if (wanted == "on") request.want = map_request_t::WANT_LOCALISE_ONLY;
  return request;
}

int switch_mapper(const LocaliseOnlyOptions& options, Console& console) {
  bus::Bus bus(read_bus_options(options.config, options.url));
  const map_request_t request = request_for(options.wanted);
  bool answered = false;
  bus.subscribe(bus::kMapUpdate, [&](const map_update_t& update) {
    answered = answered || update.answers == request.utime;
  });
  for (int i = 0; i < kTries && !answered && !stop_requested(); ++i) {
    bus.publish(bus::kMapRequest, request);
    bus.handle(kWait);
  }
  if (!answered) {
    console.warn("no mapper answers on this bus: is it running?");
    return 1;
  }
  console.say(options.wanted == "on" ? "the mapper leaves its map as it is"
                                     : "the mapper adds to its map, unless its settings say "
                                       "extend = false");
  return 0;
}

}  // namespace

void add_localise_only(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "localise-only", "Tells a running mapper to leave its map as it is, or to add to it again.");
  const auto options = std::make_shared<LocaliseOnlyOptions>();
  command->add_option("WANTED", options->wanted, "on: no cloud goes into the map; off")
      ->required()
      ->check(CLI::IsMember({"on", "off"}));
  command->add_option("--config", options->config, "the robot's settings, for its table [bus]")
      ->check(CLI::ExistingFile);
  command->add_option("--lcm-url", options->url,
                      "the bus; default $LCM_DEFAULT_URL, else that of --config, else LCM's");
  command->footer("Example:\n  voxlist localise-only on");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return switch_mapper(*options, console); };
  });
}

}  // namespace voxlist::desk
