#pragma once

#include <cstdint>
#include <string>
#include <thread>

#include "services/simulator/scanner_ports.h"

namespace voxlist {

/// Serves the scanner's ports every millisecond, in a thread of its own.
class LiveScanner {
 public:
  /// Throws as ScannerPorts does.
  LiveScanner(const MirrorScanner& scanner, const SimulatorConfig& config,
              std::int64_t start_utime_us);

 private:
  void run(const std::stop_token& stop);

  const std::int64_t start_utime_us_;
  ScannerPorts ports_;
  std::jthread thread_;
};

}  // namespace voxlist
