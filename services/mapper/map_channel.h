#pragma once

#include <cstdint>

#include "voxlist/bus/channels.h"
#include "voxlist/bus/maps/map_chunks.h"

namespace voxlist::bus {
class Bus;
class Health;
class PacedSender;
}  // namespace voxlist::bus

namespace voxlist::services {

/// A map on its channel, in paced chunks: its word, what changes in it, and the whole of it.
class MapChannel {
 public:
  /// All must outlive it. The sender may have other things to send.
  MapChannel(bus::Bus& bus, bus::Health& health, bus::PacedSender& sender,
             bus::Channel<map_update_t> channel)
      : bus_(bus), health_(health), sender_(sender), channel_(channel) {}

  /// Tells which map there is, before all that waits. `nothing_new`: a change without blocks;
  /// `answers`: utime of the request that it answers, or 0. An empty map is told whole.
  void send_word(bus::MapChange nothing_new, std::int64_t answers);

  /// Sends a change: before what waits, for listeners wait for what is new; a whole map behind it,
  /// for that takes a while.
  void send(bus::MapChange change);

  /// Whether a whole map waits: it answers whoever asks meanwhile.
  bool is_sending_whole() const { return wholes_queued_ > 0; }

  /// The sender was cleared.
  void clear() { wholes_queued_ = 0; }

 private:
  bool push(map_update_t message, bool is_first, bool ends_whole);

  bus::Bus& bus_;
  bus::Health& health_;
  bus::PacedSender& sender_;
  const bus::Channel<map_update_t> channel_;
  std::int64_t wholes_queued_ = 0;
};

}  // namespace voxlist::services
