#pragma once

#include <optional>
#include <string>

namespace voxlist::bus {

/// A network interface of this machine, as the kernel tells it.
struct NetworkInterface {
  std::string name;
  bool is_loopback = false;
  bool is_up = true;
  /// A cable is in, or a wireless network is joined.
  bool is_connected = true;
  bool has_multicast = true;
  /// Bytes of the largest packet that leaves in one piece.
  int mtu_bytes = 1500;
};

/// Nothing when there is none of this name.
std::optional<NetworkInterface> network_interface(const std::string& name);

}  // namespace voxlist::bus
