#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "voxlist/bus/counters.h"
#include "voxlist/scanner/lms200/lms200.h"

namespace voxlist::services {

/// A thread that reads an LMS 200 for ever: it finds it, reads its lines, and finds it again when
/// it is lost. Lines wait in a queue that holds the last three seconds; older ones are dropped and
/// counted as dropped_lines.
class LaserReader {
 public:
  /// Opens a serial line by its path, or throws PortError.
  using OpenPort = std::function<std::unique_ptr<serial::Port>(const std::string& path)>;

  /// Starts reading. Throws std::invalid_argument when the config is not valid.
  LaserReader(const scanner::Lms200Config& config, OpenPort open);

  /// Stops as stop() does.
  ~LaserReader();

  /// Ends the thread and leaves the device still; within a second.
  void stop();

  /// Can be read when there is news.
  int wake_fd() const { return wake_fd_; }

  /// A line, and when it came out of the thread's hands.
  struct Line {
    LaserLine line;
    std::chrono::steady_clock::time_point ready;
  };

  /// How it fares.
  struct State {
    bool connected = false;
    bool failed = false;    ///< the last attempt; `message` says why
    std::string message;    ///< what, which port, what to do; or what it is connected to
    bool polluted = false;  ///< the front window
    std::int64_t jitter_us = 0;
    double dazzled = 0.0;   ///< part of the beams, over the last second
    std::int64_t lost = 0;  ///< scans lost or refused, over the last second
  };

  /// What is new since the last call. Counts are increments.
  struct News {
    std::deque<Line> lines;
    bus::Counters counts;
    State state;
  };
  News take();

 private:
  void run(const std::stop_token& stop);
  void read(serial::Port& port, const std::stop_token& stop);
  void read_lines(scanner::Lms200& driver, const std::stop_token& stop);
  void pass_on(LaserLine line);
  void tell(const scanner::Lms200& driver);
  void tell_connected(const scanner::Lms200& driver);
  void tell_failed(const std::string& message);
  void pause(const std::stop_token& stop);
  void wake() const;

  const scanner::Lms200Config config_;
  const OpenPort open_;
  const int wake_fd_;

  // The thread's own.
  scanner::Lms200Report told_;
  std::chrono::steady_clock::time_point told_at_;
  std::chrono::milliseconds pause_;

  std::mutex mutex_;  // of news_
  std::condition_variable_any stopped_;
  News news_;

  std::jthread thread_;
};

}  // namespace voxlist::services
