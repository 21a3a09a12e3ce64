#pragma once

#include <poll.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "voxlist/serial/pseudo_terminal.h"
#include "voxlist/simulation/scanner/lms200_device.h"

namespace voxlist::scanner {

inline std::int64_t wall_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

/// A simulated LMS 200 on a pseudo-terminal, in real time or faster, in a thread of its own.
/// `measure` is called from that thread.
class LiveLms200 {
 public:
  LiveLms200(const std::filesystem::path& link, simulation::MeasureLine measure, int speed = 1)
      : terminal_(link),
        device_({.power_on_s = 0.0}, start_us_, std::move(measure)),
        speed_(speed),
        thread_([this](const std::stop_token& stop) { play(stop); }) {}

  void set_faults(const simulation::Lms200Faults& faults) {
    const std::lock_guard lock(mutex_);
    device_.set_faults(faults);
  }

 private:
  void play(const std::stop_token& stop) {
    std::vector<std::uint8_t> waiting;
    while (!stop.stop_requested()) {
      if (!terminal_.is_open()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      pollfd wanted{terminal_.fd(), POLLIN, 0};
      poll(&wanted, 1, 1);
      const std::lock_guard lock(mutex_);
      const std::int64_t now_us = start_us_ + speed_ * (wall_us() - start_us_);
      const auto bytes = terminal_.read();
      if (!bytes.empty()) device_.receive(now_us, terminal_.baud(), bytes);
      for (const simulation::TimedByte& byte : device_.sent_until(now_us, terminal_.baud()))
        waiting.push_back(byte.byte);
      const std::size_t sent = terminal_.write(waiting);
      waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(sent));
    }
  }

  const std::int64_t start_us_ = wall_us();
  serial::PseudoTerminal terminal_;
  std::mutex mutex_;  // of the device
  simulation::Lms200Device device_;
  const int speed_;
  std::jthread thread_;
};

}  // namespace voxlist::scanner
