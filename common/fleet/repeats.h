#pragma once

#include <cstdint>
#include <deque>

#include "voxlist/bus/wire.h"

namespace voxlist::fleet {

/// Knows messages that come back: where relays join two buses in a ring, each would go round for
/// ever. A message that a robot says again on purpose, seconds later, is not one of them.
class Repeats {
 public:
  /// So many of the last messages are remembered, for so long (us).
  static constexpr std::size_t kRemembered = 64;
  static constexpr std::int64_t kRemembered_us = 3'000'000;

  /// Whether the same bytes came lately. Else they are remembered.
  bool is_repeat(bus::Bytes bytes, std::int64_t now_us);

 private:
  struct Seen {
    std::uint64_t hash;
    std::int64_t at_us;
  };

  std::deque<Seen> seen_;
};

}  // namespace voxlist::fleet
