#include "voxlist/bus/multicast/network_check.h"

#include <arpa/inet.h>
#include <fmt/core.h>
#include <sys/socket.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

#include "voxlist/system/file_descriptor.h"

namespace voxlist::bus {
namespace {

// A lossy network leaves incomplete packets of 64 kB behind for as long as ipfrag_time says, which
// is 30 s by default. In 4 MB, the default, 5 % of lost frames then leave no room within two
// seconds, and nothing that is larger than a frame arrives any more.
constexpr std::int64_t kFragmentRoom = 16'000'000;

std::optional<std::int64_t> number_in(const char* path) {
  std::ifstream in(path);
  std::int64_t number = 0;
  return in >> number ? std::optional(number) : std::nullopt;
}

std::string text_of(const char* path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

// What nearly all networks carry in one piece.
constexpr int kUsualMtu = 1500;

// LCM's largest packet, and what IP puts before each piece of it.
constexpr int kLargestPacket = 65'535, kIpHeader = 20;

int pieces(int mtu_bytes) {
  const int each = std::max(8, mtu_bytes - kIpHeader);
  return (kLargestPacket + each - 1) / each;
}

std::int64_t granted_receive_buffer(int asked_bytes) {
  const FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  int granted = 0;
  socklen_t size = sizeof granted;
  setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &asked_bytes, sizeof asked_bytes);
  getsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &granted, &size);
  return granted / 2;  // the kernel tells twice what it gave, for its own needs
}

std::string route_fault(const MulticastAddress& address,
                        const std::optional<NetworkInterface>& interface) {
  const char* to_do = "ip route replace 224.0.0.0/4 dev INTERFACE";
  if (!interface) return fmt::format("there is no route for multicast: {}", to_do);
  if (!interface->is_loopback) return {};
  return fmt::format("messages for other machines (ttl={}) go to this one's loopback: {}",
                     address.ttl, to_do);
}

std::string interface_fault(const NetworkInterface& interface) {
  const std::string& name = interface.name;
  if (interface.is_loopback) return {};
  if (!interface.is_up) return fmt::format("{0} is down: ip link set dev {0} up", name);
  if (!interface.has_multicast)
    return fmt::format("{0} carries no multicast: ip link set dev {0} multicast on", name);
  if (!interface.is_connected)
    return fmt::format("{} is not connected: is its cable in, its wireless network joined?", name);
  return {};
}

NetworkFinding mtu_finding(const NetworkInterface& interface) {
  const std::string& name = interface.name;
  const int mtu = interface.mtu_bytes;
  if (interface.is_loopback || mtu == kUsualMtu) return {"mtu", false, ""};
  if (mtu > kUsualMtu)
    return {"mtu", false,
            fmt::format("the MTU of {} is {}: machines and switches with less get no large message",
                        name, mtu)};
  return {"mtu", true,
          fmt::format("the MTU of {} is {}: a packet of 64 kB is lost with any of its {} pieces, "
                      "which are {} with the usual {}; ip link set dev {} mtu {}, if the network "
                      "carries it",
                      name, mtu, pieces(mtu), pieces(kUsualMtu), kUsualMtu, name, kUsualMtu)};
}

std::string ttl_note(int ttl) {
  if (ttl <= 1) return {};
  return fmt::format("with ttl={} messages pass up to {} routers: one network needs ttl=1", ttl,
                     ttl - 1);
}

std::string receive_buffer_fault(std::int64_t granted, std::int64_t asked) {
  if (granted >= asked) return {};
  return fmt::format(
      "the receive buffer is {} kB, of {} kB asked for: large messages of other machines may get "
      "lost; sysctl -w net.core.rmem_max={}",
      granted / 1000, asked / 1000, asked);
}

std::string fragments_fault(std::optional<std::int64_t> room) {
  if (!room || *room >= kFragmentRoom) return {};
  return fmt::format(
      "there are {} kB to put fragments together: a network that loses some fills them; sysctl -w "
      "net.ipv4.ipfrag_high_thresh={} net.ipv4.ipfrag_time=2",
      *room / 1000, kFragmentRoom);
}

}  // namespace

NetworkFacts network_facts(const MulticastAddress& address, int receive_buffer_bytes) {
  return {network_interface(route_device(text_of("/proc/net/route"), address.group)),
          granted_receive_buffer(receive_buffer_bytes),
          number_in("/proc/sys/net/ipv4/ipfrag_high_thresh")};
}

std::vector<NetworkFinding> network_findings(const MulticastAddress& address,
                                             const NetworkFacts& facts, int receive_buffer_bytes) {
  if (address.ttl == 0) return {};
  std::vector<NetworkFinding> findings = {
      {"route", true, route_fault(address, facts.interface)},
      {"ttl", false, ttl_note(address.ttl)},
      {"receive_buffer", true,
       receive_buffer_fault(facts.receive_buffer_bytes, receive_buffer_bytes)},
      {"fragments", true, fragments_fault(facts.fragment_room_bytes)},
  };
  if (facts.interface) {
    findings.push_back({"interface", true, interface_fault(*facts.interface)});
    findings.push_back(mtu_finding(*facts.interface));
  }
  std::erase_if(findings, [](const NetworkFinding& f) { return f.sentence.empty(); });
  return findings;
}

std::string network_summary(const MulticastAddress& address, const NetworkFacts& facts) {
  if (address.ttl == 0) return "messages stay on this machine (ttl=0)";
  if (!facts.interface) return "messages for other machines find no way";
  return fmt::format("messages for other machines leave by {}, MTU {}, receive buffer {} kB",
                     facts.interface->name, facts.interface->mtu_bytes,
                     facts.receive_buffer_bytes / 1000);
}

// Interface, destination, gateway, flags, references, uses, metric, mask; addresses as the machine
// has them, in hexadecimal digits.
std::string route_device(const std::string& table, const std::string& group) {
  in_addr wanted{};
  if (inet_pton(AF_INET, group.c_str(), &wanted) != 1) return {};
  std::string found;
  std::uint32_t longest = 0;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    char device[17] = "";
    std::uint32_t destination = 0, mask = 0;
    const int read = std::sscanf(line.c_str(), "%16s %" SCNx32 " %*x %*x %*d %*d %*d %" SCNx32,
                                 device, &destination, &mask);
    if (read != 3 || (wanted.s_addr & mask) != destination) continue;
    if (!found.empty() && ntohl(mask) <= longest) continue;
    found = device;
    longest = ntohl(mask);
  }
  return found;
}

std::int64_t incomplete_packets() { return parse_incomplete_packets(text_of("/proc/net/snmp")); }

// Two lines each: names, and what they count.
std::int64_t parse_incomplete_packets(const std::string& table) {
  std::istringstream lines(table);
  std::string names, counts;
  while (std::getline(lines, names) && std::getline(lines, counts)) {
    if (!names.starts_with("Ip:")) continue;
    std::istringstream name_words(names), count_words(counts);
    std::string name, count;
    while (name_words >> name && count_words >> count)
      if (name == "ReasmFails") return std::atoll(count.c_str());
  }
  return 0;
}

}  // namespace voxlist::bus
