#pragma once

#include <netinet/in.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "voxlist/bus/multicast/address.h"
#include "voxlist/bus/multicast/delivery.h"
#include "voxlist/bus/multicast/listener_room.h"
#include "voxlist/bus/multicast/paced_sender.h"
#include "voxlist/bus/multicast/packets.h"

namespace voxlist::bus {

/// Sends messages as LCM's own sender does, with the same bytes, but large ones no faster than the
/// listeners of this machine read them, whose buffers hold three packets by default; LCM sends a
/// message's packets in one burst.
///
/// Small messages go out at once. Large ones are copied and sent by a thread of its own, one after
/// the other; a small one of a channel of which a large one waits goes behind it, so that the
/// messages of a channel keep their order.
///
/// A message sent as kLatest takes the place of the newest one of its channel that was sent so, as
/// long as that one waits: so it is late by two messages at most, however slow the listeners are.
class MulticastSender {
 public:
  /// Throws std::runtime_error with the system's reason.
  explicit MulticastSender(const MulticastAddress& address);

  /// Sends what still waits, for two seconds at most.
  ~MulticastSender();
  MulticastSender(const MulticastSender&) = delete;
  MulticastSender& operator=(const MulticastSender&) = delete;

  /// Sends, or queues for sending. False: the system refused it, or too much waits.
  bool send(const std::string& channel, std::span<const std::uint8_t> message,
            Delivery delivery = Delivery::kEvery);

  /// What waits to be sent.
  std::int64_t queued_bytes() const;

  /// Messages that the system refused after send() had taken them.
  std::int64_t failed() const { return failed_; }

  /// Messages that newer ones took the place of.
  std::int64_t superseded() const { return superseded_; }

 private:
  struct Queued;
  // What waits of a channel, or is being sent.
  struct Channel {
    int messages = 0;
    std::shared_ptr<Queued> newest;
  };

  bool queue(const std::string& channel, std::span<const std::uint8_t> message, Delivery delivery);
  bool replace_waiting(const std::string& channel, std::span<const std::uint8_t> message);
  void write(std::span<const std::uint8_t> message, Queued& queued);
  void send_next_packet(const std::shared_ptr<Queued>& message);
  void finish(const Queued& message);
  bool send_packet(const Packet& packet) const;
  void work();
  bool wait_for_work(std::unique_lock<std::mutex>& lock);
  bool listeners_have_room();

  const sockaddr_in to_;
  const int fd_;
  mutable std::mutex mutex_;  // of all down to failed_
  std::condition_variable changed_;
  PacedSender queue_;
  std::int64_t queued_bytes_ = 0;
  std::map<std::string, Channel> waiting_;
  std::uint32_t number_ = 0;
  bool ending_ = false;
  std::optional<std::int64_t> end_us_;
  std::atomic<std::int64_t> failed_ = 0;
  std::atomic<std::int64_t> superseded_ = 0;
  ListenerRoom room_;  // of the thread alone
  std::thread thread_;
};

}  // namespace voxlist::bus
