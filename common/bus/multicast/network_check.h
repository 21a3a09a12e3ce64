#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/bus/multicast/address.h"
#include "voxlist/bus/multicast/network_interface.h"

namespace voxlist::bus {

/// What of this machine decides whether messages between machines arrive.
struct NetworkFacts {
  /// The interface by which packets to the address leave; nothing when no route leads there.
  std::optional<NetworkInterface> interface;
  /// What the kernel gives of the receive buffer that it is asked for.
  std::int64_t receive_buffer_bytes = 0;
  /// The memory in which the kernel puts fragments together; nothing where it does not tell.
  std::optional<std::int64_t> fragment_room_bytes;
};

NetworkFacts network_facts(const MulticastAddress& address, int receive_buffer_bytes);

/// One thing that is not as it should be.
struct NetworkFinding {
  /// One of few: "route", "interface", "ttl", "mtu", "receive_buffer", "fragments".
  std::string key;
  /// Messages get lost by it, more than they would otherwise; else it is just to be known.
  bool is_fault = true;
  /// What, and what to do.
  std::string sentence;
};

/// What makes messages between machines (ttl 1 and more) get lost. Nothing for messages that stay
/// on this machine. `receive_buffer_bytes`: asked of the kernel.
std::vector<NetworkFinding> network_findings(const MulticastAddress& address,
                                             const NetworkFacts& facts, int receive_buffer_bytes);

/// Where messages go, in a line: "leave by eth0, ttl 1, MTU 1500".
std::string network_summary(const MulticastAddress& address, const NetworkFacts& facts);

/// The interface that packets to this address leave by, of the text of /proc/net/route: that of the
/// narrowest route; empty when there is no way.
std::string route_device(const std::string& table, const std::string& group);

/// Packets that the kernel could not put together since it was started, as a fragment of each was
/// lost or came too late; 0 where it does not tell. Of all sockets of this machine (or network
/// namespace).
std::int64_t incomplete_packets();

/// The same, of the text of /proc/net/snmp.
std::int64_t parse_incomplete_packets(const std::string& table);

}  // namespace voxlist::bus
