#pragma once

#include <cstdint>

namespace voxlist::bus {

/// What the network does behind a Bus's back.
struct Traffic {
  /// Published, and still to be sent.
  std::int64_t queued_bytes = 0;
  /// Published, but refused by the system when it was their turn.
  std::int64_t failed_messages = 0;
  /// Published, but left for newer ones before it was their turn (Delivery::kLatest).
  std::int64_t superseded_messages = 0;
  /// Packets that the kernel had no room for when they came: the message of each is lost.
  std::int64_t dropped_packets = 0;
  /// Packets of other machines of which a fragment got lost on its way: the message of each is
  /// lost. Of all who listen on this machine, since the Bus was made; 0 where messages stay on one
  /// machine.
  std::int64_t incomplete_packets = 0;
};

}  // namespace voxlist::bus
