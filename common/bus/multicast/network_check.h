#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "voxlist/bus/multicast/address.h"

namespace voxlist::bus {

/// What of this machine's network makes messages between machines (ttl 1 and more) get lost, a
/// sentence each with what to do: the route leads nowhere, receive buffers are small, or so is the
/// room in which the kernel puts fragments together. `receive_buffer_bytes`: asked of the kernel.
/// Nothing for messages that stay on this machine.
std::vector<std::string> network_findings(const MulticastAddress& address,
                                          int receive_buffer_bytes);

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
