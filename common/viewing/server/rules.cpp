#include "voxlist/viewing/server/rules.h"

#include <algorithm>

namespace voxlist::viewing {
namespace {

Ruling refuse(unsigned status, const char* why) { return {Deed::kRefuse, status, why}; }

// An address in numbers: no name that somebody else gives out.
bool is_numeric(std::string_view host) {
  if (host.starts_with('[')) return host.ends_with(']');
  const auto fits = [](char c) { return (c >= '0' && c <= '9') || c == '.'; };
  return !host.empty() && std::ranges::all_of(host, fits);
}

bool is_own_host(std::string_view host, const Rules& rules) {
  std::string port(":");
  port += std::to_string(rules.port);
  if (!host.ends_with(port)) return false;
  host.remove_suffix(port.size());
  if (host == "127.0.0.1" || host == "[::1]" || host == "localhost") return true;
  return rules.is_open && is_numeric(host);
}

bool is_own_origin(const Asked& asked) {
  constexpr std::string_view kScheme = "http://";
  return asked.origin->starts_with(kScheme) && asked.origin->substr(kScheme.size()) == *asked.host;
}

// Takes as long for a wrong token as for the right one.
bool are_equal(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

// Whoever only looks on may come from any path, and from pages that are allowed to.
Ruling rule_foreign_upgrade(const Asked& asked, const Rules& rules) {
  const bool is_allowed =
      !asked.origin || is_own_origin(asked) ||
      std::ranges::find(rules.foreign_origins, *asked.origin) != rules.foreign_origins.end();
  return is_allowed ? Ruling{Deed::kForeignUpgrade} : refuse(403, "another origin");
}

Ruling rule_upgrade(const Asked& asked, const Rules& rules) {
  if (asked.method != "GET") return refuse(405, "a WebSocket begins with GET");
  if (foreign_protocol(asked, rules)) return rule_foreign_upgrade(asked, rules);
  if (asked.target != kLivePath) return refuse(404, "no WebSocket is here");
  if (asked.origin && !is_own_origin(asked)) return refuse(403, "another origin");
  if (!asked.subprotocols || !lists(*asked.subprotocols, kLiveProtocol))
    return refuse(400, "none of these subprotocols is known");
  return {Deed::kUpgrade};
}

Ruling rule_command(const Asked& asked, const Rules& rules) {
  if (asked.method != "POST") return refuse(405, "commands are posted");
  if (!asked.origin || !is_own_origin(asked)) return refuse(403, "another origin");
  if (!asked.token || !are_equal(*asked.token, rules.token)) return refuse(403, "a wrong token");
  if (asked.content_type != "application/json") return refuse(415, "commands are JSON");
  return {Deed::kCommand};
}

}  // namespace

bool lists(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());
    std::string_view one = list.substr(0, comma);
    list.remove_prefix(std::min(comma + 1, list.size()));
    while (one.starts_with(' ')) one.remove_prefix(1);
    while (one.ends_with(' ')) one.remove_suffix(1);
    if (one == word) return true;
  }
  return false;
}

const std::string* foreign_protocol(const Asked& asked, const Rules& rules) {
  if (!asked.subprotocols || lists(*asked.subprotocols, kLiveProtocol)) return nullptr;
  for (const std::string& name : rules.foreign_protocols)
    if (lists(*asked.subprotocols, name)) return &name;
  return nullptr;
}

Ruling rule(const Asked& asked, const Rules& rules) {
  if (asked.repeats_a_header) return refuse(400, "a header is there twice");
  if (!asked.host || !is_own_host(*asked.host, rules)) return refuse(421, "another host");
  if (asked.wants_upgrade) return rule_upgrade(asked, rules);
  if (asked.target.starts_with(kCommandPath)) return rule_command(asked, rules);
  if (asked.method != "GET" && asked.method != "HEAD") return refuse(405, "files are only read");
  return {Deed::kFile};
}

}  // namespace voxlist::viewing
