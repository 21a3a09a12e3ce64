#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/bus/event_log.h"
#include "voxlist/mapping/map_builder.h"

namespace voxlist::desk {

/// Messages in the order of their times, which can be had again from the first one on.
class Events {
 public:
  virtual ~Events() = default;
  virtual std::optional<bus::Event> next() = 0;
  virtual void rewind() = 0;
};

/// Those of a recording; channels without the robot's prefix, of others' none.
class LogEvents : public Events {
 public:
  /// Throws std::runtime_error when the log cannot be opened.
  LogEvents(std::string path, std::string prefix);
  std::optional<bus::Event> next() override;
  void rewind() override { reader_ = bus::EventLogReader(path_); }

 private:
  std::string path_, prefix_;
  bus::EventLogReader reader_;
};

/// What a map folder tells: its map and free space, then where the robot was at each time, as a
/// mapper and a localiser would have said it.
class MapEvents : public Events {
 public:
  MapEvents(const OccupancyMap& map, const OccupancyMap& free_space,
            const std::vector<StampedPose3>& poses);
  std::optional<bus::Event> next() override;
  void rewind() override { next_ = 0; }

 private:
  void add_map(bus::Channel<map_update_t> channel, const OccupancyMap& map, std::int64_t utime_us);
  void add_pose(const StampedPose3& pose);
  template <class M>
  void add(bus::Channel<M> channel, std::int64_t utime_us, const M& message);

  std::vector<bus::Event> events_;
  std::size_t next_ = 0;
};

}  // namespace voxlist::desk
