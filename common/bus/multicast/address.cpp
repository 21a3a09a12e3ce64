#include "voxlist/bus/multicast/address.h"

#include <regex>

namespace voxlist::bus {
namespace {

// The ttl among the options behind the address; -1 when it is no number that a packet can have.
int ttl_of(const std::string& options) {
  static const std::regex form(R"([?&]ttl=(\w+))");
  std::smatch found;
  if (!std::regex_search(options, found, form)) return MulticastAddress{}.ttl;
  static const std::regex number(R"(\d{1,3})");
  const std::string ttl = found[1];
  return std::regex_match(ttl, number) && std::stoi(ttl) <= 255 ? std::stoi(ttl) : -1;
}

}  // namespace

std::optional<MulticastAddress> multicast_address(const std::string& url) {
  static const std::regex form(
      R"(udpm://((\d{1,3})\.\d{1,3}\.\d{1,3}\.\d{1,3}(:(\d{1,5}))?)?(\?[a-z_]+=\w+(&[a-z_]+=\w+)*)?)");
  std::smatch parts;
  if (!std::regex_match(url, parts, form)) return std::nullopt;
  MulticastAddress address;
  const std::string host = parts[1];
  if (!host.empty()) address.group = host.substr(0, host.find(':'));
  if (parts[4].matched) address.port = std::stoi(parts[4]);
  address.ttl = ttl_of(parts[5]);
  const int first = parts[2].matched ? std::stoi(parts[2]) : 239;
  const bool is_one = first >= 224 && first <= 239 && address.port >= 1 && address.port <= 65535;
  return is_one && address.ttl >= 0 ? std::optional(address) : std::nullopt;
}

}  // namespace voxlist::bus
