#pragma once

#include <cstdint>

#include "services/simulator/simulator_config.h"
#include "voxlist/simulation/scanner/lms200_device.h"

namespace voxlist::services {

/// The laser's fault, put on the device when its time comes and taken off when it is over.
class LaserFaults {
 public:
  /// Throws std::invalid_argument for a fault of no known name.
  explicit LaserFaults(const LaserFaultConfig& config);

  /// Sees to the device at a time of the run; `utime_us` is the device's clock.
  void apply(double run_s, std::int64_t utime_us, simulation::Lms200Device& device);

 private:
  const LaserFaultConfig config_;
  simulation::Lms200Faults faults_;
  bool on_ = false;
};

}  // namespace voxlist::services
