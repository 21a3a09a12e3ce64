#pragma once

#include <string>

namespace voxlist::scanner {

/// How an LMS 200 is to be used.
struct Lms200Config {
  std::string port = "/dev/ttyUSB0";
  int baud = 500'000;
  double resolution_deg = 1.0;
  int range_m = 8;
  bool write_configuration = true;
  double power_on_wait_s = 5.0;
  double delay_ms = 6.667;

  template <class Visitor>
  void visit(Visitor& v) {
    v("port", port, "serial line of the LMS 200");
    v("baud", baud, "500000, 38400, 19200 or 9600; only the first brings all 75 lines a second",
      9600, 500'000);
    v("resolution_deg", resolution_deg,
      "1, 0.5 or 0.25: lines in turn begin 0, (0.25,) 0.5 (, 0.75) deg later", 0.25, 1.0);
    v("range_m", range_m, "greatest range: 8, 16, 32 in millimetres, 80 in centimetres", 8, 80);
    v("write_configuration", write_configuration,
      "into the device's memory, when it differs; else it measures as it is set");
    v("power_on_wait_s", power_on_wait_s,
      "silence for so long is told as an error; the search goes on", 0.0, 120.0);
    v("delay_ms", delay_ms, "from a line's first beam until the device begins to send it", 0.0,
      100.0);
  }
};

/// Why a device cannot be used with this config, as one line for a person; empty when it can.
std::string why_invalid(const Lms200Config& config);

}  // namespace voxlist::scanner
