#pragma once

#include <filesystem>
#include <string>

#include "voxlist/bus/bus.h"

namespace voxlist::desk {

/// The bus of the services that run with this settings file: its table [bus], then LCM_DEFAULT_URL
/// of the environment, then `url`; empty ones are left out. Throws std::runtime_error with all
/// complaints about the file.
bus::BusOptions read_bus_options(const std::filesystem::path& file, const std::string& url);

}  // namespace voxlist::desk
