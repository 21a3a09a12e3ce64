#include "services/simulator/scanner_ports.h"

#include <fmt/core.h>

#include <cmath>
#include <vector>

#include "voxlist/service/run_folder.h"

namespace voxlist::services {
namespace {

simulation::Lms200Device::Config device_config(const SimulatorConfig& config) {
  simulation::Lms200Device::Config device;
  device.turns_per_second = config.simulation.scanner.turns_per_second;
  device.seed = static_cast<std::uint64_t>(config.simulation.seed);
  return device;
}

// A counter of 32 bits, which goes round every 71 minutes.
std::uint32_t controller_us(double run_s) {
  return static_cast<std::uint32_t>(ScannerPorts::kControllerStart_us + std::llround(run_s * 1e6));
}

}  // namespace

ScannerPorts::ScannerPorts(const simulation::MirrorScanner& scanner, const SimulatorConfig& config,
                           std::int64_t start_utime_us)
    : scanner_(scanner),
      start_utime_us_(start_utime_us),
      latency_us_(std::llround(config.simulation.latency_ms * 1e3)),
      laser_port_(port_link(config.laser_port, "laser")),
      clock_port_(port_link(config.clock_port, "mirror_clock")),
      laser_adapter_(config.usb_latency_ms),
      clock_adapter_(config.usb_latency_ms),
      faults_(config.laser_fault),
      laser_(device_config(config), start_utime_us,
             [this](std::int64_t utime_us, double first_angle_rad) {
               LaserLine line = scanner_.measure(utime_us - start_utime_us_, first_angle_rad);
               line.utime_us = utime_us;
               return line;
             }) {}

void ScannerPorts::serve(std::int64_t now_us) {
  serve_laser(now_us);
  serve_clock(now_us);
}

void ScannerPorts::serve_laser(std::int64_t now_us) {
  const std::int64_t device_us = now_us - latency_us_;
  if (device_us < start_utime_us_) return;
  faults_.apply(static_cast<double>(now_us - start_utime_us_) * 1e-6, device_us, laser_);
  const int baud = laser_port_.baud();
  std::vector<std::uint8_t> bytes;
  for (const simulation::TimedByte& sent : laser_.sent_until(device_us, baud))
    bytes.push_back(sent.byte);
  laser_.receive(device_us, baud, laser_port_.read());
  laser_adapter_.take(bytes);
  laser_port_.write(laser_adapter_.given_until(now_us));
}

void ScannerPorts::serve_clock(std::int64_t now_us) {
  clock_port_.read();
  std::string text;
  const double run_s = static_cast<double>(now_us - start_utime_us_) * 1e-6;
  for (; scanner_.motor().edge_s(edge_) <= run_s; ++edge_) {
    const double edge_s = scanner_.motor().edge_s(edge_);
    if (scanner_.motor().clock_seen(edge_s)) text += fmt::format("{}\n", controller_us(edge_s));
  }
  clock_adapter_.take({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  clock_port_.write(clock_adapter_.given_until(now_us));
}

std::filesystem::path port_link(const std::string& setting, const char* name) {
  return setting.empty() ? service::run_folder() / name : std::filesystem::path(setting);
}

}  // namespace voxlist::services
