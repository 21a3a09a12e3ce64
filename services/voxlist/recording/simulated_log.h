#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "voxlist/bus/event_log.h"
#include "voxlist/scanner/mirror/mirror_clock.h"
#include "voxlist/scanner/sweep/cloud_assembler.h"
#include "voxlist/simulation/run/simulated_run.h"

namespace voxlist::desk {

/// Writes a simulated run as an LCM log: what the robot's base and laser say, and what the
/// services' own classes make of it. A line is used when a driver would have it, half a turn and a
/// telegram after its first beam; each message stands in the log at the time when it would be
/// heard.
class SimulatedLog {
 public:
  /// Start of a run in the log: a time that looks like a day's (us).
  static constexpr std::int64_t kStart_us = 1'700'000'000'000'000;

  /// How many of each were written.
  struct Counts {
    std::int64_t lines = 0, clouds = 0, slices = 0, odometry = 0;
  };

  /// What clouds are put together by.
  enum class Deskew { kWheels, kTruth };

  /// Throws as EventLogWriter and CloudAssembler do.
  SimulatedLog(const std::string& path, const std::string& prefix,
               const simulation::MirrorScannerConfig& scanner,
               const scanner::CloudAssemblerConfig& assembler, Deskew deskew);

  // The run's events, in its order.
  void operator()(const simulation::SimulatedOdometry& event);
  void operator()(const simulation::SimulatedTruth& event);
  void operator()(const simulation::SimulatedClockEdge& event);
  void operator()(const LaserLine& line);
  void operator()(const Cloud& cloud);

  /// Uses the lines that were still under way. Throws as EventLogWriter::close does.
  void close();

  const Counts& counts() const { return counts_; }

 private:
  void hear_lines(std::int64_t until_us);
  void hear(const LaserLine& line, std::int64_t heard_us);
  void write(const scanner::Assembly& assembly, std::int64_t heard_us);

  bus::EventLogWriter log_;
  scanner::MirrorClock mirror_;
  scanner::CloudAssembler assembler_;
  const Deskew deskew_;
  std::deque<LaserLine> under_way_;
  Counts counts_;
};

}  // namespace voxlist::desk
