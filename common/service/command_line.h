#pragma once

#include <optional>

#include "config/config.h"
#include "service/service.h"

namespace voxlist {

struct BusOptions;

/// The table [bus] of a settings file.
Section bus_section(BusOptions& options);

/// Fills the service's settings and the bus options: defaults, then the file of --config, then for
/// the LCM URL the environment's LCM_DEFAULT_URL, then --lcm-url. Returns the exit code if there is
/// nothing to run: 0 after --help and --print-config, 1 after complaints (on stderr, one a line).
std::optional<int> read_command_line(int argc, char** argv, const ServiceInfo& info,
                                     const Section& settings, BusOptions& bus);

}  // namespace voxlist
