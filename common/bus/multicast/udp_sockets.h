#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace voxlist::bus {

/// A UDP socket of this machine (or network namespace), as the kernel lists it.
struct UdpSocket {
  int port = 0;
  /// What the kernel holds for it that it has not read, packets with their bookkeeping.
  std::int64_t waiting_bytes = 0;
  std::uint64_t inode = 0;
  /// Packets that it had no room for, since it was opened.
  std::int64_t dropped_packets = 0;
};

/// Reads the kernel's table (the text of /proc/net/udp). Lines that are none are left out.
std::vector<UdpSocket> parse_udp_sockets(const std::string& table);

/// The sockets bound to this port, of every process. Nothing where the kernel does not tell. Cost:
/// some 20 us.
std::optional<std::vector<UdpSocket>> udp_sockets(int port);

/// Packets that the sockets of this process at this port had no room for.
std::int64_t dropped_by_own_sockets(int port);

}  // namespace voxlist::bus
