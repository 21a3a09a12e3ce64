#include "tests/soak/watch.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <utility>

#include "tests/soak/answers.h"

namespace voxlist::soak {
namespace {

// What HEALTH counts where a message, or a line of the laser, was lost: by the network, by a queue
// that was full, by bytes that are no message, or because what belongs to it did not come.
constexpr std::array<std::string_view, 4> kOfNetwork = {
    "packets_without_room", "packets_incomplete", "messages_not_sent", "messages_left_for_newer"};
constexpr std::array<std::string_view, 19> kOfChannel = {
    "truncated",     "wrong_type",   "bad_length",       "bad_text",      "trailing_bytes",
    "too_large",     "codec_failed", "handler_failed",   "queue_full",    "dropped_while_waiting",
    "cloud_missing", "incomplete",   "missing",          "no_mirror_yet", "mirror_unknown",
    "no_odometry",   "out_of_order", "too_many_waiting", "too_few_lines"};

bool is_loss(std::string_view counter) {
  if (std::ranges::find(kOfNetwork, counter) != kOfNetwork.end()) return true;
  const std::string_view what = counter.substr(counter.find('/') + 1);
  return what.starts_with("unsent_") || std::ranges::find(kOfChannel, what) != kOfChannel.end();
}

// "waits for keyframe 12" and "waits for keyframe 13" are one trouble.
std::string without_numbers(const std::string& message) {
  std::string text;
  for (const char c : message) {
    const bool is_digit = c >= '0' && c <= '9';
    if (!is_digit) text += c;
    if (is_digit && (text.empty() || text.back() != 'N')) text += 'N';
  }
  return text;
}

}  // namespace

std::map<std::string, std::int64_t> losses(const health_t& health) {
  std::map<std::string, std::int64_t> lost;
  for (const counter_t& counter : health.counters)
    if (is_loss(counter.name)) lost[counter.name] = counter.count;
  return lost;
}

std::optional<double> cpu_of(std::int32_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  // The program's name is in brackets and may hold anything; 11 fields on are user and system time.
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return std::nullopt;
  std::istringstream fields(text.substr(name_end + 1));
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  double user = 0.0, system = 0.0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

void Watch::take(const health_t& health) {
  if (health.pid != pid_) {
    if (pid_ != 0) ++now_.restarts;
    pid_ = health.pid;
    lost_.clear();
    cpu_s_ = 0.0;
  }
  ++now_.healths;
  for (const auto& [name, count] : losses(health)) {
    if (count > lost_[name]) now_.lost[name] += count - lost_[name];
    lost_[name] = count;
  }
  if (health.state != health_t::STATE_OK) ++now_.troubles[without_numbers(health.message)];
  for (const gauge_t& gauge : health.gauges)
    if (gauge.name == "memory_MB") memory_MB_.push_back(gauge.value);
  if (health.latency_p50_ms >= 0.0F) p50_ms_.push_back(health.latency_p50_ms);
  if (health.latency_p99_ms >= 0.0F) p99_ms_.push_back(health.latency_p99_ms);
}

ServiceTime Watch::since_last() {
  now_.memory_MB = percentile(memory_MB_, 50.0);
  now_.latency_p50_ms = percentile(p50_ms_, 50.0);
  now_.latency_p99_ms = percentile(p99_ms_, 50.0);
  if (const auto cpu_s = cpu_of(pid_)) {
    now_.cpu_s = *cpu_s - cpu_s_;
    cpu_s_ = *cpu_s;
  }
  memory_MB_.clear();
  p50_ms_.clear();
  p99_ms_.clear();
  return std::exchange(now_, {});
}

}  // namespace voxlist::soak
