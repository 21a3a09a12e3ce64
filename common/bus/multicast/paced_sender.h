#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>

namespace voxlist::bus {

/// Sends queued messages a few at a time, so that a whole map never overruns a listener's receive
/// buffer: lcm's sender does not pace. First in, first out, but short ones may go before long ones.
class PacedSender {
 public:
  struct Options {
    /// Sustained rate. 20 kB/ms: a map of 10 MB takes half a second; a loaded listener still keeps
    /// up.
    std::int64_t bytes_per_ms = 20'000;
    /// Most bytes that are sent at once, however long nothing was sent. Well below the system's
    /// default receive buffer (212,992 B).
    std::int64_t burst_bytes = 130'000;
    /// Above it push() refuses.
    std::int64_t max_queued_bytes = 256'000'000;
  };

  PacedSender() = default;
  explicit PacedSender(const Options& options) : options_(options) {}

  /// Queues a message of that many bytes, which `send` will send. False: the queue is full, nothing
  /// was queued.
  bool push(std::size_t bytes, std::function<void()> send) { return push(bytes, send, queue_); }

  /// The same for what somebody waits for: it goes before all that came by push(), after what came
  /// by push_first().
  bool push_first(std::size_t bytes, std::function<void()> send) {
    return push(bytes, send, first_);
  }

  /// Sends what may be sent at this time. Call it often; time that goes back earns nothing.
  void run(std::int64_t now_us);

  bool idle() const { return queue_.empty() && first_.empty(); }
  std::int64_t queued_bytes() const { return queued_bytes_; }

  /// Forgets what is queued: for a map that is no longer the current one.
  void clear();

 private:
  struct Item {
    std::int64_t bytes;
    std::function<void()> send;
  };

  bool push(std::size_t bytes, std::function<void()>& send, std::deque<Item>& queue);
  void send_one(std::deque<Item>& queue);

  Options options_;
  std::deque<Item> first_, queue_;
  std::int64_t queued_bytes_ = 0;
  // May go below zero: a message goes out whole, and is paid for before the next.
  std::int64_t budget_bytes_ = 0;
  std::int64_t last_run_us_ = 0;
  bool has_run_ = false;
};

}  // namespace voxlist::bus
