#include "voxlist/bus/health.h"

#include <unistd.h>

#include <algorithm>
#include <utility>
#include <voxlist/health_t.hpp>

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

}  // namespace

void Health::set_state(State state, std::string message) {
  state_ = state;
  message_ = std::move(message);
}

void Health::add_latency_us(std::int64_t latency_us) {
  // Below zero: the wall clock was set back meanwhile.
  latency_us = std::max<std::int64_t>(latency_us, 0);
  max_latency_us_ = std::max(max_latency_us_, latency_us);
  if (latencies_us_.size() < kMaxLatencies) latencies_us_.push_back(latency_us);
}

std::optional<health_t> Health::due(std::int64_t now_us, const Counters& more) {
  if (last_us_ && now_us >= *last_us_ && now_us - *last_us_ < kPeriod_us) return std::nullopt;
  last_us_ = now_us;

  health_t message{};
  message.utime = now_us;
  message.service = service_;
  message.pid = getpid();
  message.state = static_cast<std::int32_t>(state_);
  message.message = message_;
  for (const Counters* counters : {&std::as_const(counters_), &more}) {
    for (const auto& [name, count] : *counters) message.counters.push_back({name, count});
  }
  message.n_counters = static_cast<std::int32_t>(message.counters.size());

  std::ranges::sort(latencies_us_);
  message.latency_p50_ms = percentile_ms(latencies_us_, 50);
  message.latency_p99_ms = percentile_ms(latencies_us_, 99);
  message.latency_max_ms =
      max_latency_us_ < 0 ? -1.0F : static_cast<float>(max_latency_us_) / 1000.0F;
  latencies_us_.clear();
  max_latency_us_ = -1;
  return message;
}

}  // namespace voxlist::bus
