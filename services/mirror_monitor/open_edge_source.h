#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "voxlist/serial/edge_source.h"

namespace voxlist::services {

/// Whether the setting `clock` names a device: it does unless it is "none".
bool names_a_clock(const std::string& where);

/// Makes the source of a clock's edges: "gpio:gpiochip0/17", "modem:/dev/ttyS0:cts" (dcd, dsr, ri),
/// "text:/dev/ttyACM0@115200" (serial port, pseudo-terminal or fifo; the speed may be left out), or
/// "none": null. The device is opened at the first read, and again whenever it is gone. `clock`
/// tells when text arrives: the wall clock. Throws std::invalid_argument for anything else.
std::unique_ptr<serial::EdgeSource> open_edge_source(const std::string& where,
                                                     std::function<std::int64_t()> clock);

}  // namespace voxlist::services
