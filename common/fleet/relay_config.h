#pragma once

#include <array>
#include <string>
#include <vector>

namespace voxlist::fleet {

enum class Direction {
  kOut,  ///< from the robot's bus to the fleet's
  kIn,   ///< from the fleet's bus to the robot's
};
inline constexpr std::array<const char*, 2> kDirectionNames = {"out", "in"};

/// Channels that are passed on: `[[relay.channel]]` in a settings file.
struct RelayChannel {
  std::string name;
  Direction direction = Direction::kOut;
  std::string robot = "*";
  double max_hz = 10.0;
  double max_kBps = 100.0;
  bool clouds = false;

  template <class Visitor>
  void visit(Visitor& v) {
    v("name", name, "of the channel, without a robot's name; * stands for any letters");
    v("direction", direction, kDirectionNames,
      "`out`: from this robot's bus to the fleet's; `in`: from the fleet's to this robot's");
    v("robot", robot, "whose channel comes in; * stands for any letters; of no meaning for `out`");
    v("max_hz", max_hz, "messages a second of each channel, in the mean of a second", 0.01, 1000.0);
    v("max_kBps", max_kBps, "kB a second of each channel; one message goes out whole", 0.1,
      100'000.0);
    v("clouds", clouds, "also when its messages are raw clouds or keyframes");
  }
};

/// Settings of the relay.
struct RelayConfig {
  std::string robot;
  std::string url = "udpm://239.255.76.68:7670?ttl=1";
  int receive_buffer_bytes = 8'000'000;
  std::vector<RelayChannel> channels;

  template <class Visitor>
  void visit(Visitor& v) {
    v("robot", robot,
      "this robot's name in the fleet, put before its channels: letters, digits, _ and -");
    v("url", url, "the fleet's LCM network; its port must not be that of the robot's own bus");
    v("receive_buffer_bytes", receive_buffer_bytes, "asked of the kernel for the fleet's bus",
      100'000, 1'000'000'000);
    v("channel", channels, "what is passed on; the defaults where there is none");
  }

  /// Those that are listed. Where none is: POSE, LOCALISATION, HEALTH and GRID_* out, and POSE and
  /// LOCALISATION of the others in.
  std::vector<RelayChannel> channels_in_use() const;
};

/// Why no relay can work so; empty when one can.
std::string why_invalid(const RelayConfig& config);

}  // namespace voxlist::fleet
