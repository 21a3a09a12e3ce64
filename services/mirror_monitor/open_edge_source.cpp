#include "services/mirror_monitor/open_edge_source.h"

#include <charconv>
#include <optional>
#include <set>
#include <stdexcept>

#include "services/mirror_monitor/gpio_edge_source.h"
#include "voxlist/serial/line_speed.h"
#include "voxlist/serial/modem_edge_source.h"
#include "voxlist/serial/reopened_edge_source.h"
#include "voxlist/serial/text_edge_source.h"

namespace voxlist::services {
namespace {

// Speed of a text stream that names none: the usual one of microcontrollers.
constexpr int kUsualBaud = 115'200;

struct Parts {
  std::string first, second;
};

// "a<mark>b", split at the last mark.
std::optional<Parts> split(const std::string& text, char mark) {
  const std::size_t at = text.rfind(mark);
  if (at == std::string::npos || at == 0 || at + 1 == text.size()) return std::nullopt;
  return Parts{text.substr(0, at), text.substr(at + 1)};
}

std::optional<int> number(const std::string& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0) return std::nullopt;
  return value;
}

[[noreturn]] void refuse(const std::string& where) {
  throw std::invalid_argument("clock = \"" + where +
                              "\" is not \"gpio:CHIP/PIN\", \"modem:PORT:cts\" (dcd, dsr, ri), "
                              "\"text:PORT@BAUD\" or \"none\"");
}

}  // namespace

bool names_a_clock(const std::string& where) { return where != "none"; }

std::unique_ptr<serial::EdgeSource> open_edge_source(const std::string& where,
                                                     std::function<std::int64_t()> clock) {
  if (!names_a_clock(where)) return nullptr;
  serial::ReopenedEdgeSource::Open open;
  if (where.starts_with("gpio:")) {
    const auto parts = split(where.substr(5), '/');
    const auto pin = parts ? number(parts->second) : std::nullopt;
    if (!pin) refuse(where);
    open = [chip = parts->first, pin = static_cast<unsigned>(*pin)] {
      return std::make_unique<GpioEdgeSource>(chip, pin);
    };
  } else if (where.starts_with("modem:")) {
    const auto parts = split(where.substr(6), ':');
    if (!parts || !std::set<std::string>{"cts", "dcd", "dsr", "ri"}.contains(parts->second))
      refuse(where);
    open = [parts = *parts] {
      return std::make_unique<serial::ModemEdgeSource>(parts.first, parts.second);
    };
  } else if (where.starts_with("text:") && where.size() > 5) {
    const auto parts = split(where.substr(5), '@');
    const auto baud = parts ? number(parts->second) : kUsualBaud;
    if (!baud || !serial::line_speed(*baud)) refuse(where);
    open = [path = parts ? parts->first : where.substr(5), baud = *baud, clock = std::move(clock)] {
      return std::make_unique<serial::TextEdgeSource>(path, baud, clock);
    };
  } else {
    refuse(where);
  }
  return std::make_unique<serial::ReopenedEdgeSource>(std::move(open));
}

}  // namespace voxlist::services
