#pragma once

#include <optional>

#include "voxlist/config/config.h"
#include "voxlist/service/service.h"

namespace voxlist::bus {
struct BusOptions;
}

namespace voxlist::service {

/// The table [bus] of a settings file.
config::Section bus_section(bus::BusOptions& options);

/// Fills the service's settings and the bus options: defaults, then the file of --config, then for
/// the LCM URL the environment's LCM_DEFAULT_URL, then --lcm-url. Returns the exit code if there is
/// nothing to run: 0 after --help, --version, --print-config and --check-config, 1 after complaints
/// (on stderr, one a line).
std::optional<int> read_command_line(int argc, char** argv, const ServiceInfo& info,
                                     const std::vector<config::Section>& settings,
                                     const CheckSettings& check, bus::BusOptions& bus);

}  // namespace voxlist::service
