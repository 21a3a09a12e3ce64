#pragma once

#include <cstdint>

#include "services/simulator/simulator_config.h"
#include "simulation/lms200_device.h"

namespace voxlist {

/// The laser's fault, put on the device when its time comes and taken off when it is over.
class LaserFaults {
 public:
  /// Throws std::invalid_argument for a fault of no known name.
  explicit LaserFaults(const LaserFaultConfig& config);

  /// Sees to the device at a time of the run; `utime_us` is the device's clock.
  void apply(double run_s, std::int64_t utime_us, Lms200Device& device);

 private:
  const LaserFaultConfig config_;
  Lms200Faults faults_;
  bool on_ = false;
};

}  // namespace voxlist
