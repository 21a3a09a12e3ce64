#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "voxlist/bus/channels.h"
#include "voxlist/bus/counters.h"
#include "voxlist/bus/multicast/delivery.h"
#include "voxlist/bus/traffic.h"
#include "voxlist/bus/wire.h"

namespace voxlist::bus {

/// Where a Bus connects.
struct BusOptions {
  /// udpm://GROUP:PORT?ttl=N (0: this machine, 1: this network), memq:// (this object alone), or
  /// file://PATH (reads an event log, one event a handle(); nothing can be published).
  std::string url = "udpm://239.255.76.67:7667?ttl=0";

  /// Put before every channel name, to tell robots apart: letters, digits, _ - /.
  std::string prefix;

  /// Receive buffer asked of the kernel, which gives as much of it as it is allowed to. What a Bus
  /// sends arrives with the system's usual 212,992 B; what LCM's own sender sends, from about 200
  /// kB on, hardly ever does.
  int receive_buffer_bytes = 8'000'000;
};

/// Why no Bus can be made of the options, whatever the machine: a prefix or url that makes no
/// sense. Empty when one can.
std::string why_invalid(const BusOptions& options);

/// Whether a url names a recording, which ends, and not a network.
bool is_recording(const std::string& url);

/// The one door to LCM. Nothing that arrives, and nothing that a handler throws, gets past it:
/// bytes are checked before they are decoded, and what is refused is counted by reason. Use one Bus
/// from one thread.
///
/// One gap is not ours to close: a forged fragment of a large message can crash liblcm's own
/// reassembly, so the network is to be trusted with packets, if not with messages.
///
/// counters(), where CH is the channel without prefix, has CH/sent and CH/unsent_<reason> for what
/// was published, and for what came in, once handle() has returned:
/// CH/received = CH/handled + CH/handler_failed + CH/superseded + the sum of CH/<fault_name>.
class Bus {
 public:
  /// Connects. Throws std::runtime_error that says what, where, and what to do about it.
  explicit Bus(const BusOptions& options);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Sends a message, or counts why it could not be sent. With kLatest it takes the place of one
  /// that listeners were too slow for: see MulticastSender.
  template <class M>
  void publish(Channel<M> channel, const M& message, Delivery delivery = Delivery::kEvery) {
    std::vector<std::uint8_t> bytes;
    const Fault fault = encode(message, bytes);
    if (fault != Fault::kNone) return count_unsent(channel.name, fault_name(fault));
    publish_encoded(channel.name, bytes, delivery);
  }

  /// Sends bytes as they are: for replaying recordings. They are not checked.
  void publish_encoded(const std::string& channel, Bytes bytes,
                       Delivery delivery = Delivery::kEvery);

  /// Calls `handler` from within handle() with messages of the channel: kEvery at once, the newest
  /// (kLatest) after all kEvery messages that wait, for handlers slower than their channel. Once a
  /// channel: a second time throws std::logic_error.
  template <class M>
  void subscribe(Channel<M> channel, std::function<void(const std::type_identity_t<M>&)> handler,
                 Delivery delivery = Delivery::kEvery) {
    const auto take = [handler = std::move(handler)](Bytes bytes) {
      M message{};
      const Fault fault = decode(bytes, message);
      if (fault == Fault::kNone) handler(message);
      return fault;
    };
    subscribe_encoded(channel.name, &check_wire<M>, take, delivery);
  }

  /// The same for a handler that reads the message where it lies (CloudView). The bytes are a whole
  /// M, until the handler returns.
  template <class M>
  void subscribe_bytes(Channel<M> channel, std::function<void(Bytes)> handler,
                       Delivery delivery = Delivery::kEvery) {
    const auto take = [handler = std::move(handler)](Bytes bytes) {
      const Fault fault = check_wire<M>(bytes);
      if (fault == Fault::kNone) handler(bytes);
      return fault;
    };
    subscribe_encoded(channel.name, &check_wire<M>, take, delivery);
  }

  /// Calls `handler`, from within handle(), with every message of the channels that one of the
  /// patterns matches (channel_pattern.h), by the channel's name without prefix; the bytes are not
  /// checked. For whoever passes messages on, or knows no names beforehand. Once a Bus, and with
  /// patterns that match no channel which is subscribed to by name (else throws std::logic_error).
  void subscribe_all(const std::vector<std::string>& patterns,
                     std::function<void(const std::string&, Bytes)> handler);

  /// Waits up to `timeout` for a message, then handles all that wait (256 at most). A signal ends
  /// the wait early, and so does `wake_fd` when it can be read: a device, for the service to look
  /// at. False: nothing will come any more, because the log has ended or the connection
  /// broke.
  bool handle(std::chrono::milliseconds timeout, int wake_fd = -1);

  /// Can be read when a message waits, for whoever waits for other things as well; -1: there is no
  /// such thing.
  int file_descriptor() const;

  /// What happened so far, by channel.
  const Counters& counters() const;

  /// Those of counters() that count messages which were lost: neither handled nor sent, and not
  /// superseded by a newer one either.
  const Counters& losses() const;

  /// What the network does behind all that, until now. Cost: some 100 us.
  Traffic traffic() const;

  /// "CHANNEL: what" of the first exception that left a handler; empty when none did.
  const std::string& first_handler_error() const;

  /// When the message being handled arrived here, or was recorded: microseconds of the wall clock.
  std::int64_t arrival_utime_us() const;

 private:
  using Check = Fault (*)(Bytes);
  using Take = std::function<Fault(Bytes)>;

  void subscribe_encoded(const std::string& channel, Check check, Take take, Delivery delivery);
  void count_unsent(const std::string& channel, const char* reason);

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace voxlist::bus
