#include "voxlist/bus/health.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <utility>
#include <voxlist/health_t.hpp>

#include "voxlist/system/version.h"

namespace voxlist::bus {
namespace {

// HEALTH goes out once a second (us); latencies that are kept for its percentiles: far more than
// messages in a second, so that a flood costs no memory.
constexpr std::int64_t kPeriod_us = 1'000'000;
constexpr std::size_t kMaxLatencies = 10'000;

// Nearest rank; -1 ms when there is none, as health_t says.
float percentile_ms(const std::vector<std::int64_t>& sorted_us, std::size_t percent) {
  if (sorted_us.empty()) return -1.0F;
  const std::size_t rank = (percent * sorted_us.size() + 99) / 100;
  return static_cast<float>(sorted_us[rank - 1]) / 1000.0F;
}

bool is_control(char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; }

}  // namespace

void Health::raise(const std::string& key, State state, std::string sentence) {
  if (sentence.empty()) return clear(key);
  // One line, and no zero inside: a sentence may quote what came from outside.
  std::ranges::replace_if(sentence, is_control, ' ');
  conditions_[key] = {state, std::move(sentence)};
}

Health::State Health::state() const {
  State worst = State::kOk;
  for (const auto& [key, condition] : conditions_) worst = std::max(worst, condition.state);
  return worst;
}

std::string Health::message() const {
  std::string all;
  for (const State state : {State::kError, State::kWarning, State::kOk}) {
    for (const auto& [key, condition] : conditions_) {
      if (condition.state != state) continue;
      if (!all.empty()) all += "; ";
      all += condition.sentence;
    }
  }
  return all;
}

void Health::add_latency_us(std::int64_t latency_us) {
  // Below zero: the wall clock was set back meanwhile.
  latency_us = std::max<std::int64_t>(latency_us, 0);
  max_latency_us_ = std::max(max_latency_us_, latency_us);
  if (latencies_us_.size() < kMaxLatencies) latencies_us_.push_back(latency_us);
}

std::optional<health_t> Health::due(std::int64_t now_us, const Counters& more) {
  if (last_us_ && now_us >= *last_us_ && now_us - *last_us_ < kPeriod_us) return std::nullopt;
  return last(now_us, more);
}

health_t Health::last(std::int64_t now_us, const Counters& more) {
  last_us_ = now_us;

  health_t message{};
  message.utime = now_us;
  message.service = service_;
  message.pid = getpid();
  message.version = version();
  message.state = static_cast<std::int32_t>(state());
  message.message = this->message();
  for (const Counters* counters : {&std::as_const(counters_), &more}) {
    for (const auto& [name, count] : *counters) message.counters.push_back({name, count});
  }
  message.n_counters = static_cast<std::int32_t>(message.counters.size());
  for (const auto& [name, value] : gauges_) message.gauges.push_back({name, value});
  message.n_gauges = static_cast<std::int32_t>(message.gauges.size());
  write_latencies(message);
  return message;
}

void Health::write_latencies(health_t& message) {
  std::ranges::sort(latencies_us_);
  message.latency_p50_ms = percentile_ms(latencies_us_, 50);
  message.latency_p99_ms = percentile_ms(latencies_us_, 99);
  message.latency_max_ms =
      max_latency_us_ < 0 ? -1.0F : static_cast<float>(max_latency_us_) / 1000.0F;
  latencies_us_.clear();
  max_latency_us_ = -1;
}

}  // namespace voxlist::bus
