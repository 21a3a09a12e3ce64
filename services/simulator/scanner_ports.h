#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "services/simulator/laser_faults.h"
#include "services/simulator/simulator_config.h"
#include "services/simulator/usb_adapter.h"
#include "voxlist/serial/pseudo_terminal.h"
#include "voxlist/simulation/scanner/lms200_device.h"
#include "voxlist/simulation/scanner/mirror_scanner.h"

namespace voxlist::services {

/// The scanner as drivers meet it: an LMS 200 on one pseudo-terminal; on another a microcontroller
/// that writes a line for each step of the mirror's motor, with the microseconds since it was
/// switched on, in 32 bits.
class ScannerPorts {
 public:
  /// Time of the microcontroller's clock at the run's start: it was switched on before.
  static constexpr std::int64_t kControllerStart_us = 5'000'000;

  /// The run, and the laser's power, begins at `start_utime_us`. Throws PortError, and
  /// std::invalid_argument for an unknown fault. The scanner must outlive it.
  ScannerPorts(const simulation::MirrorScanner& scanner, const SimulatorConfig& config,
               std::int64_t start_utime_us);

  /// Does what is due until a time: reads requests, writes what has left the devices. What finds no
  /// room is lost, as with a host that does not read. Call it about every millisecond.
  void serve(std::int64_t now_us);

 private:
  void serve_laser(std::int64_t now_us);
  void serve_clock(std::int64_t now_us);

  const simulation::MirrorScanner& scanner_;
  const std::int64_t start_utime_us_;
  const std::int64_t latency_us_;
  serial::PseudoTerminal laser_port_, clock_port_;
  UsbAdapter laser_adapter_, clock_adapter_;
  LaserFaults faults_;
  simulation::Lms200Device laser_;
  std::int64_t edge_ = 0;  // of the clock, the next
};

/// Where a port's link is: as the settings say, else of this name in the run folder.
std::filesystem::path port_link(const std::string& setting, const char* name);

}  // namespace voxlist::services
