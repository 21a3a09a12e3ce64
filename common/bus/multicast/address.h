#pragma once

#include <optional>
#include <string>

namespace voxlist::bus {

/// Where a udpm:// url sends to.
struct MulticastAddress {
  std::string group = "239.255.76.67";
  int port = 7667;
  /// Routers that a packet may pass; 0: it stays on this machine.
  int ttl = 0;
};

/// The address of udpm://GROUP:PORT?ttl=N, LCM's own where something is left out. Nothing when the
/// url is no such thing.
std::optional<MulticastAddress> multicast_address(const std::string& url);

}  // namespace voxlist::bus
