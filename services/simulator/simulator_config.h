#pragma once

#include <string>

#include "voxlist/simulation/run/simulation_config.h"

namespace voxlist::services {

/// A fault of the simulated laser for a time of the run.
struct LaserFaultConfig {
  std::string name;  ///< of a member of Lms200Faults, or "power_cycle"; empty: none
  double from_s = 10.0;
  double to_s = 12.0;
  double probability = 0.001;
};

/// Settings of the simulator.
struct SimulatorConfig {
  std::string output = "scanner";
  double speed = 1.0;
  std::string laser_port;
  std::string clock_port;
  int usb_latency_ms = 1;
  LaserFaultConfig laser_fault;
  simulation::SimulationConfig simulation;

  template <class Visitor>
  void visit(Visitor& v) {
    v("output", output,
      "`scanner`: an LMS 200 and a motor's clock on pseudo-terminals, in real time; `cloud`: ideal "
      "CLOUD messages");
    v("speed", speed, "times real time; only with `output = \"cloud\"`", 0.01, 1000.0);
    v("laser_port", laser_port, "link to the laser's port; empty: `laser` in the run folder");
    v("clock_port", clock_port,
      "link to the clock's port; empty: `mirror_clock` in the run folder");
    v("usb_latency_ms", usb_latency_ms,
      "both ports' bytes wait for an adapter's timer this long at most; 0: not at all", 0, 255);
    v("laser_fault", laser_fault.name,
      "`drop_byte`, `corrupt_byte`, `noise_byte`, `dazzle`, `over_max` (with a probability), "
      "`refuse`, `silent`, `address_81`, `wrong_unit`, `partial_bits`, `pollution`, "
      "`power_cycle`; empty: none");
    v("laser_fault_from_s", laser_fault.from_s, "of the run", 0.0, 86'400.0);
    v("laser_fault_to_s", laser_fault.to_s, "of the run", 0.0, 86'400.0);
    v("laser_fault_probability", laser_fault.probability, "for a byte or a beam", 0.0, 1.0);
    simulation.visit(v);
  }
};

}  // namespace voxlist::services
