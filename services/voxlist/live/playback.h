#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "voxlist/bus/event_log.h"

namespace voxlist::desk {

/// The messages of a recording, each with the time at which it is to be sent.
class Playback {
 public:
  struct Due {
    /// After the first one, microseconds; never less than that of the one before.
    std::int64_t after_us = 0;
    bus::Event event;
  };

  /// The files of the recording in their order; channels in whose names `only` is found; `speed`
  /// times as fast as it was recorded (above 0).
  Playback(std::vector<std::filesystem::path> parts, const std::string& only, double speed);

  /// The next one; nothing at the end. Throws std::runtime_error when a file cannot be opened.
  std::optional<Due> next();

 private:
  std::optional<bus::Event> next_event();

  std::vector<std::filesystem::path> parts_;
  std::regex only_;
  double speed_;
  std::unique_ptr<bus::EventLogReader> reader_;
  std::size_t next_part_ = 0;
  std::optional<std::int64_t> first_utime_us_;
  std::int64_t after_us_ = 0;
};

}  // namespace voxlist::desk
