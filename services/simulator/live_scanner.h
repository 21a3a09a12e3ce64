#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

#include "services/simulator/scanner_ports.h"

namespace voxlist::services {

/// Serves the scanner's ports every millisecond, in a thread of its own.
class LiveScanner {
 public:
  /// The run begins now, which is `start_utime_us`. Throws as ScannerPorts does.
  LiveScanner(const simulation::MirrorScanner& scanner, const SimulatorConfig& config,
              std::int64_t start_utime_us);

 private:
  using Clock = std::chrono::steady_clock;

  void run(const std::stop_token& stop);

  const Clock::time_point start_ = Clock::now();  // before the ports are made, which takes a while
  const std::int64_t start_utime_us_;
  ScannerPorts ports_;
  std::jthread thread_;
};

}  // namespace voxlist::services
