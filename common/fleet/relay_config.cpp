#include "voxlist/fleet/relay_config.h"

#include <fmt/core.h>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/channel_pattern.h"

namespace voxlist::fleet {
namespace {

// A robot's name and a slash leave room for the longest channel in LCM's 63 letters.
constexpr std::size_t kMaxName = 31;

RelayChannel channel(const char* name, Direction direction, double max_hz, double max_kBps) {
  RelayChannel made;
  made.name = name;
  made.direction = direction;
  made.max_hz = max_hz;
  made.max_kBps = max_kBps;
  return made;
}

bool has_slash(const std::string& name) { return name.find('/') != std::string::npos; }

std::string why_invalid(const RelayChannel& row) {
  if (!bus::is_channel_pattern(row.name) || has_slash(row.name))
    return fmt::format("channel '{}' may only have letters, digits, _, - and *", row.name);
  if (!bus::is_channel_pattern(row.robot) || has_slash(row.robot))
    return fmt::format("robot '{}' of channel {} may only have letters, digits, _, - and *",
                       row.robot, row.name);
  return {};
}

}  // namespace

std::vector<RelayChannel> RelayConfig::channels_in_use() const {
  if (!channels.empty()) return channels;
  return {
      channel("POSE", Direction::kOut, 10.0, 10.0),
      channel("LOCALISATION", Direction::kOut, 5.0, 50.0),
      // One channel for the words of all services: fewer a second would leave some of them out.
      channel("HEALTH", Direction::kOut, 30.0, 200.0),
      channel("GRID_*", Direction::kOut, 1.0, 500.0),
      channel("POSE", Direction::kIn, 10.0, 10.0),
      channel("LOCALISATION", Direction::kIn, 5.0, 50.0),
  };
}

std::string why_invalid(const RelayConfig& config) {
  if (config.robot.empty()) return "robot must say what this robot is called in the fleet";
  if (!bus::is_plain_channel(config.robot) || has_slash(config.robot) ||
      config.robot.size() > kMaxName)
    return fmt::format("robot '{}' may only have letters, digits, _ and -, {} at most",
                       config.robot, kMaxName);
  if (const std::string why = bus::why_invalid({.url = config.url, .prefix = ""}); !why.empty())
    return why;
  if (bus::is_recording(config.url)) return "url must be a network, not a recording";
  for (const RelayChannel& row : config.channels)
    if (const std::string why = why_invalid(row); !why.empty()) return why;
  return {};
}

}  // namespace voxlist::fleet
