#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace voxlist::serial {

/// Where the edges of a clock come from: a pin, a modem line, a microcontroller. Use it from one
/// thread.
class EdgeSource {
 public:
  virtual ~EdgeSource() = default;

  /// The edges since the last call, wall clock, microseconds; never waits. Throws PortError when
  /// the device is gone, but for sources that open it again (reopened_edge_source.h), which need to
  /// know the time, of any clock that never jumps.
  virtual std::vector<std::int64_t> read(std::int64_t now_us) = 0;

  /// Can be read when there are edges; -1: there is none now.
  virtual int wake_fd() const = 0;

  /// One line: why no edges can come, and what to do; empty when they can.
  virtual std::string trouble() const { return {}; }

  /// What came and was no edge.
  virtual std::int64_t garbage() const { return 0; }
};

}  // namespace voxlist::serial
