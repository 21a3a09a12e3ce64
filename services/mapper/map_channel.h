#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "voxlist/bus/channels.h"
#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/bus/maps/whole_map.h"

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

  /// Sends a change before what waits, for listeners wait for what is new.
  void send(bus::MapChange change);

  /// Sends the whole map, as it is now, behind what waits, for that takes a while. `word`: which
  /// map it is.
  void send_whole(bus::MapChange word, const OccupancyMap& map);

  /// Whether a whole map waits: it answers whoever asks meanwhile.
  bool is_sending_whole() const { return wholes_queued_ > 0; }

  /// The sender was cleared.
  void clear() { wholes_queued_ = 0; }

 private:
  void push_first(map_update_t message);
  bool push_chunk(const std::shared_ptr<bus::WholeMap>& whole, std::size_t chunk);
  bool note_queued(bool queued);

  bus::Bus& bus_;
  bus::Health& health_;
  bus::PacedSender& sender_;
  const bus::Channel<map_update_t> channel_;
  std::int64_t wholes_queued_ = 0;
};

}  // namespace voxlist::services
