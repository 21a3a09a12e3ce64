#include "services/voxlist/live/health_board.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <voxlist/health_t.hpp>

namespace voxlist::desk {
namespace {

// A service that speaks once a second is silent after this (s): two of its messages may be lost.
constexpr double kSilent_s = 3.0;

// Services that are shown at most, and characters of a name: names come from the network.
constexpr std::size_t kMaxServices = 64;
constexpr std::size_t kMaxName = 20;

// What comes from the network must not steer the terminal.
std::string printable(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; }, '?');
  return text;
}

constexpr char kRow[] = "{:<20} {:<8} {:>9} {:>8} {:>7}  {}{}";

// Its gauge has a column of its own; of others so many are shown.
constexpr char kMemory[] = "memory_MB";
constexpr std::size_t kMaxGauges = 16;

std::map<std::string, double> gauges_of(const health_t& message) {
  std::map<std::string, double> gauges;
  for (const gauge_t& gauge : message.gauges)
    if (gauges.size() < kMaxGauges && std::isfinite(gauge.value))
      gauges[printable(gauge.name).substr(0, 2 * kMaxName)] = gauge.value;
  return gauges;
}

// Those that are not 0: " [map_voxels 41234]".
std::string other_gauges(const std::map<std::string, double>& gauges) {
  std::string text;
  for (const auto& [name, value] : gauges)
    if (name != kMemory && value != 0.0)
      text += fmt::format("{}{} {:.6g}", text.empty() ? " [" : ", ", name, value);
  return text.empty() ? text : text + ']';
}

std::string state_name(std::int32_t state) {
  if (state == health_t::STATE_OK) return "OK";
  if (state == health_t::STATE_WARNING) return "WARNING";
  return "ERROR";
}

}  // namespace

HealthBoard::HealthBoard(std::vector<std::string> expected) {
  for (const std::string& name : expected) entries_[name];
}

void HealthBoard::take(const health_t& message, double now_s) {
  const std::string name = printable(message.service).substr(0, kMaxName);
  if (name.empty() || (!entries_.contains(name) && entries_.size() >= kMaxServices)) return;
  entries_[name] = {true,
                    now_s,
                    message.state,
                    message.latency_p99_ms,
                    printable(message.message),
                    gauges_of(message)};
}

bool HealthBoard::all_heard() const {
  return !entries_.empty() &&
         std::ranges::all_of(entries_, [](const auto& e) { return e.second.heard; });
}

bool HealthBoard::is_well(double now_s) const {
  return !entries_.empty() && std::ranges::all_of(entries_, [now_s](const auto& e) {
    const std::string state = state_of(e.second, now_s);
    return state == "OK" || state == "WARNING";
  });
}

std::vector<std::string> HealthBoard::table(double now_s) const {
  std::vector<std::string> lines = {
      fmt::format(kRow, "SERVICE", "STATE", "P99", "MEMORY", "AGE", "REASON", "")};
  for (const auto& [name, entry] : entries_) {
    const bool has_latency = entry.heard && entry.latency_p99_ms >= 0.0F;
    const auto memory = entry.gauges.find(kMemory);
    lines.push_back(
        fmt::format(kRow, name, state_of(entry, now_s),
                    has_latency ? fmt::format("{:.1f} ms", entry.latency_p99_ms) : "-",
                    memory != entry.gauges.end() ? fmt::format("{:.0f} MB", memory->second) : "-",
                    entry.heard ? fmt::format("{:.0f} s", now_s - entry.heard_s) : "-",
                    reason_of(entry, now_s), other_gauges(entry.gauges)));
    while (lines.back().ends_with(' ')) lines.back().pop_back();
  }
  return lines;
}

std::vector<std::string> HealthBoard::troubles(double now_s) const {
  std::vector<std::string> lines;
  for (const auto& [name, entry] : entries_) {
    const std::string state = state_of(entry, now_s), reason = reason_of(entry, now_s);
    if (state != "OK" || !reason.empty())
      lines.push_back(fmt::format("{}: {}{}{}", name, state, reason.empty() ? "" : ": ", reason));
  }
  return lines;
}

std::string HealthBoard::state_of(const Entry& entry, double now_s) {
  if (!entry.heard || now_s - entry.heard_s > kSilent_s) return "SILENT";
  return state_name(entry.state);
}

std::string HealthBoard::reason_of(const Entry& entry, double now_s) {
  if (!entry.heard) return "no HEALTH heard: does it run on this bus?";
  if (now_s - entry.heard_s <= kSilent_s) return entry.message;
  return fmt::format("nothing heard for {:.0f} s; it was {}{}{}", now_s - entry.heard_s,
                     state_name(entry.state), entry.message.empty() ? "" : ": ", entry.message);
}

}  // namespace voxlist::desk
