#include "voxlist/bus/multicast/network_check.h"

#include <arpa/inet.h>
#include <fmt/core.h>

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

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

}  // namespace

std::vector<std::string> network_findings(const MulticastAddress& address,
                                          int receive_buffer_bytes) {
  std::vector<std::string> findings;
  if (address.ttl == 0) return findings;
  if (route_device(text_of("/proc/net/route"), address.group) == "lo")
    findings.push_back(fmt::format(
        "messages for other machines (ttl={}) go to this one's loopback: ip route replace "
        "224.0.0.0/4 dev INTERFACE",
        address.ttl));
  if (const auto most = number_in("/proc/sys/net/core/rmem_max");
      most && *most < receive_buffer_bytes)
    findings.push_back(fmt::format(
        "the receive buffer is {} kB, of {} kB asked for: large messages of other machines may get "
        "lost; sysctl -w net.core.rmem_max={}",
        *most / 1000, receive_buffer_bytes / 1000, receive_buffer_bytes));
  const auto room = number_in("/proc/sys/net/ipv4/ipfrag_high_thresh");
  if (room && *room < kFragmentRoom)
    findings.push_back(
        fmt::format("there are {} kB to put fragments together: a network that loses some fills "
                    "them; sysctl -w net.ipv4.ipfrag_high_thresh={} net.ipv4.ipfrag_time=2",
                    *room / 1000, kFragmentRoom));
  return findings;
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
