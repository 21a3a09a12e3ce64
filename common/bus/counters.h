#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace voxlist::bus {

/// How often each thing happened, by name ("CLOUD/truncated"), in the names' order.
using Counters = std::map<std::string, std::int64_t>;

}  // namespace voxlist::bus
