#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/voxlist/view/events.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/viewing/bus_feed.h"
#include "voxlist/viewing/viewer.h"

namespace voxlist::desk {

/// Brings a viewer to any time of a recording: forwards by what lies between, backwards from the
/// beginning on. Messages go over a bus of its own, so they are checked as live ones are.
class Replay {
 public:
  Replay(std::unique_ptr<Events> events, viewing::Viewer& viewer,
         const std::vector<std::string>& robots);

  /// Goes on to a time, or part of the way: `most` messages at most. What would be out of date at
  /// that time anyway (clouds of before) is left out. False: it is not there yet.
  bool advance(std::int64_t utime_us, int most);

  /// All from the beginning on again.
  void rewind();

  /// The time of what was shown last.
  std::int64_t now_us() const { return now_us_; }

 private:
  void show(const bus::Event& event);
  void take(const map_update_t& message);

  std::unique_ptr<Events> events_;
  viewing::Viewer& viewer_;
  bus::Bus bus_;
  viewing::BusFeed feed_;
  bus::MapAssembler assembler_, space_assembler_;
  std::optional<bus::Event> next_;
  std::int64_t now_us_ = 0;
};

}  // namespace voxlist::desk
