#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/voxlist/view/events.h"

namespace voxlist::desk {

/// What happened in a recording, and when (us).
struct Highlights {
  struct Span {
    std::int64_t from_us, to_us;
  };

  std::int64_t begin_us = 0, end_us = 0;
  /// LOST, each time.
  std::vector<Span> lost;
  /// Loops that were closed.
  std::vector<std::int64_t> loops;
  /// A service said that something is wrong, each time that it had been well before.
  std::vector<std::int64_t> warnings;
  /// Whether there is a map in it.
  bool has_map = false;

  /// As the page's time bar reads it.
  std::string json(const std::string& name) const;
};

/// Reads all events once, and rewinds. Gives up, with what it has, when somebody asks to stop.
Highlights highlights_of(Events& events);

}  // namespace voxlist::desk
