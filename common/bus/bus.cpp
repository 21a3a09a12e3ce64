#include "voxlist/bus/bus.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "voxlist/bus/channel_pattern.h"
#include "voxlist/bus/multicast/address.h"
#include "voxlist/bus/transport.h"

namespace voxlist::bus {
namespace {

// Messages of a channel that may wait; liblcm drops the newest when the queue is full. kEvery: five
// seconds of 100 Hz odometry behind a slow handler. kLatest: four seconds of slices, which cost
// memory while they wait only to be skipped.
constexpr int kEveryCapacity = 512;
constexpr int kLatestCapacity = 64;

// Leaves 24 of the 63 letters of a channel's name for the longest channel.
constexpr std::size_t kMaxPrefix = 39;

constexpr std::string_view kFileScheme = "file://";

// In counters, where one subscription takes all channels: their names come from the network.
constexpr const char* kAll = "all";

std::string log_path(const std::string& url) {
  return url.substr(kFileScheme.size(), url.find('?') - kFileScheme.size());
}

struct Waiting {
  std::vector<std::uint8_t> bytes;
  std::int64_t arrival_utime_us = 0;
};

struct Subscription {
  std::string channel;
  Fault (*check)(Bytes);
  std::function<Fault(Bytes)> take;
  Delivery delivery;
  std::optional<Waiting> waiting;
};

}  // namespace

struct Bus::Impl {
  std::string prefix;
  std::unique_ptr<Transport> transport;
  // Each by its name on the wire. A map keeps its entries in place: handlers may subscribe while
  // one of them runs.
  std::map<std::string, Subscription> subscriptions;
  std::vector<std::string> patterns;  // of what goes to take_all
  std::function<void(const std::string&, Bytes)> take_all;
  Counters counters;
  Counters losses;
  std::string first_handler_error;
  std::int64_t arrival_utime_us = 0;

  void count(const std::string& channel, const char* what) { ++counters[channel + '/' + what]; }

  void count_loss(const std::string& channel, const char* what) {
    count(channel, what);
    ++losses[channel + '/' + what];
  }

  void count_handled(const std::string& channel, Fault fault) {
    if (fault == Fault::kNone) return count(channel, "handled");
    count_loss(channel, fault_name(fault));
  }

  void handler_failed(const std::string& channel, const char* what) {
    count_loss(channel, "handler_failed");
    if (first_handler_error.empty()) first_handler_error = channel + ": " + what;
  }

  void deliver(const Subscription& to, Bytes bytes, std::int64_t arrival) {
    arrival_utime_us = arrival;
    try {
      count_handled(to.channel, to.take(bytes));
    } catch (const std::exception& error) {
      handler_failed(to.channel, error.what());
    } catch (...) {
      handler_failed(to.channel, "an exception that is no std::exception");
    }
  }

  // Checked on arrival, so that a bad message never supersedes a good one.
  void keep(Subscription& to, const RawMessage& message) {
    if (const Fault fault = to.check(message.bytes); fault != Fault::kNone) {
      return count_loss(to.channel, fault_name(fault));
    }
    if (to.waiting) count(to.channel, "superseded");
    to.waiting = Waiting{{message.bytes.begin(), message.bytes.end()}, message.arrival_utime_us};
  }

  void receive_other(const RawMessage& message) {
    if (!matches_any(patterns, message.channel)) return;
    const std::string channel = message.channel.substr(prefix.size());
    deliver({kAll,
             nullptr,
             [&](Bytes bytes) { return take_all(channel, bytes), Fault::kNone; },
             {},
             {}},
            message.bytes, message.arrival_utime_us);
  }

  void receive(const RawMessage& message) {
    const auto found = subscriptions.find(message.channel);
    if (found == subscriptions.end()) return receive_other(message);
    Subscription& to = found->second;
    count(to.channel, "received");
    if (to.delivery == Delivery::kEvery) {
      deliver(to, message.bytes, message.arrival_utime_us);
    } else {
      keep(to, message);
    }
  }

  void deliver_waiting() {
    for (auto& [wire_name, to] : subscriptions) {
      if (!to.waiting) continue;
      const Waiting message = std::move(*to.waiting);
      to.waiting.reset();
      deliver(to, message.bytes, message.arrival_utime_us);
    }
  }
};

bool is_recording(const std::string& url) { return url.starts_with(kFileScheme); }

std::string why_invalid(const BusOptions& options) {
  if (!is_plain_channel(options.prefix) || options.prefix.size() > kMaxPrefix)
    return fmt::format("channel prefix '{}' may only hold letters, digits, _ - and /, {} at most",
                       options.prefix, kMaxPrefix);
  if (is_recording(options.url) || options.url.starts_with("memq://")) return {};
  if (multicast_address(options.url)) return {};
  return fmt::format(
      "url '{}' cannot be opened: use udpm://GROUP:PORT?ttl=N (GROUP 224.0.0.0 to "
      "239.255.255.255), memq:// or "
      "file://PATH",
      options.url);
}

Bus::Bus(const BusOptions& options) : impl_(std::make_unique<Impl>()) {
  if (const std::string wrong = why_invalid(options); !wrong.empty())
    throw std::runtime_error("bus: " + wrong);
  impl_->prefix = options.prefix;
  impl_->transport =
      is_recording(options.url) ? open_log(log_path(options.url)) : open_lcm(options);
}

Bus::~Bus() = default;

void Bus::publish_encoded(const std::string& channel, Bytes bytes, Delivery delivery) {
  const std::string wire_name = impl_->prefix + channel;
  const bool sent =
      wire_name.size() <= kMaxChannelName && impl_->transport->send(wire_name, bytes, delivery);
  if (sent) return impl_->count(channel, "sent");
  impl_->count_loss(channel, "unsent_refused");
}

void Bus::count_unsent(const std::string& channel, const char* reason) {
  impl_->count_loss(channel, ("unsent_" + std::string(reason)).c_str());
}

void Bus::subscribe_encoded(const std::string& channel, Check check, Take take, Delivery delivery) {
  const std::string wire_name = impl_->prefix + channel;
  if (!is_plain_channel(channel) || wire_name.size() > kMaxChannelName) {
    throw std::runtime_error(
        fmt::format("bus: channel name {} is longer than 63 or not plain", wire_name));
  }
  if (impl_->subscriptions.contains(wire_name) || matches_any(impl_->patterns, wire_name)) {
    throw std::logic_error("bus: subscribed twice to " + wire_name);
  }
  impl_->transport->listen({wire_name},
                           delivery == Delivery::kEvery ? kEveryCapacity : kLatestCapacity);
  impl_->subscriptions.emplace(wire_name,
                               Subscription{channel, check, std::move(take), delivery, {}});
}

void Bus::subscribe_all(const std::vector<std::string>& patterns,
                        std::function<void(const std::string&, Bytes)> handler) {
  std::vector<std::string> wire_patterns;
  for (const std::string& pattern : patterns) {
    if (!is_channel_pattern(pattern))
      throw std::runtime_error("bus: " + pattern + " is no pattern of channels");
    wire_patterns.push_back(impl_->prefix + pattern);
  }
  const auto is_taken = [&](const auto& by_name) {
    return matches_any(wire_patterns, by_name.first);
  };
  if (impl_->take_all || std::ranges::any_of(impl_->subscriptions, is_taken))
    throw std::logic_error("bus: subscribed twice to what a pattern matches");
  impl_->patterns = wire_patterns;
  impl_->take_all = std::move(handler);
  impl_->transport->listen(wire_patterns, kEveryCapacity);
}

int Bus::file_descriptor() const { return impl_->transport->file_descriptor(); }

bool Bus::handle(std::chrono::milliseconds timeout, int wake_fd) {
  using Received = Transport::Received;
  const auto receiver = [this](const RawMessage& message) { impl_->receive(message); };
  Received last = Received::kMessage;
  for (int n = 0; n < impl_->transport->batch() && last == Received::kMessage; ++n) {
    last = impl_->transport->receive(n == 0 ? timeout : std::chrono::milliseconds(0), wake_fd,
                                     receiver);
  }
  impl_->deliver_waiting();
  return last != Received::kEnded;
}

const Counters& Bus::counters() const { return impl_->counters; }

const Counters& Bus::losses() const { return impl_->losses; }

Traffic Bus::traffic() const { return impl_->transport->traffic(); }

const std::string& Bus::first_handler_error() const { return impl_->first_handler_error; }

std::int64_t Bus::arrival_utime_us() const { return impl_->arrival_utime_us; }

}  // namespace voxlist::bus
