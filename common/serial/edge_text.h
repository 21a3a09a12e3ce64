#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "voxlist/serial/device_time.h"

namespace voxlist::serial {

/// Reads a microcontroller's text: one line for each edge, "<microseconds of its own clock>\n", in
/// decimal, of 32 bits that wrap or of more. Torn lines and garbage are counted and skipped.
class EdgeText {
 public:
  /// Takes bytes that arrived at a time; the edges that they complete, wall clock, microseconds.
  std::vector<std::int64_t> feed(std::int64_t arrival_us, std::span<const std::uint8_t> bytes);

  std::int64_t garbage() const { return garbage_; }

 private:
  void end_line(std::int64_t arrival_us, std::vector<std::int64_t>& edges_us);

  std::string line_;
  bool whole_ = false;  // the line's beginning was seen
  DeviceTime time_;
  std::int64_t garbage_ = 0;
};

}  // namespace voxlist::serial
