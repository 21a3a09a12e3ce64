#pragma once

#include <filesystem>
#include <string>

namespace voxlist::serial {

/// Asks a USB adapter to hand on bytes at once instead of gathering them (FTDI: for 16 ms, longer
/// than a scan). Says in one line what is wrong and what to do when it cannot; empty: all is well,
/// or the port has no such setting.
std::string quicken_adapter(const std::filesystem::path& port,
                            const std::filesystem::path& sysfs = "/sys/bus/usb-serial/devices");

}  // namespace voxlist::serial
