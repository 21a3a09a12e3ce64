#include "services/laser_driver/laser_driver_service.h"

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <stdexcept>
#include <voxlist/planar_lidar_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/serial/serial_port.h"

namespace voxlist::services {
namespace {

// A larger share of dazzled beams than this, more than three of 181, comes from something that a
// person can turn away: HEALTH warns.
constexpr double kDazzled = 0.02;

std::unique_ptr<serial::Port> open_serial(const std::string& path) {
  auto port = std::make_unique<serial::SerialPort>(path, 9600);
  if (!port->warning().empty()) spdlog::warn("{}", port->warning());
  return port;
}

}  // namespace

LaserDriverService::LaserDriverService(bus::Bus& bus, bus::Health& health,
                                       const scanner::Lms200Config& config)
    : bus_(bus), health_(health), port_(config.port), reader_(config, open_serial) {}

void LaserDriverService::check(const scanner::Lms200Config& config) {
  if (const std::string wrong = why_invalid(config); !wrong.empty())
    throw std::invalid_argument(wrong);
}

void LaserDriverService::tick(std::int64_t) {
  const LaserReader::News news = reader_.take();
  for (const LaserReader::Line& line : news.lines) publish(line);
  for (const auto& [what, times] : news.counts) health_.count(what, times);
  tell(news.state);
}

void LaserDriverService::publish(const LaserReader::Line& line) {
  bus_.publish(bus::kLaser, bus::to_message(line.line));
  const auto waited = std::chrono::steady_clock::now() - line.ready;
  health_.add_latency_us(std::chrono::duration_cast<std::chrono::microseconds>(waited).count());
}

void LaserDriverService::tell(const LaserReader::State& state) {
  using S = bus::Health::State;
  health_.count("jitter_us", state.jitter_us - told_jitter_us_);
  told_jitter_us_ = state.jitter_us;
  const std::string searching = state.connected ? "" : "looking for the LMS 200 on " + port_;
  health_.raise("device", state.failed ? S::kError : S::kWarning,
                state.failed ? state.message : searching);
  const auto warn = [&](const char* key, bool holds, const std::string& sentence) {
    health_.raise(key, S::kWarning, state.connected && holds ? sentence : "");
  };
  const std::string laser = "the LMS 200 on " + port_;
  warn("window", state.polluted, laser + " needs its front window cleaned");
  warn("dazzle", state.dazzled > kDazzled,
       fmt::format("{} is dazzled in {:.0f} % of its beams", laser, 100.0 * state.dazzled));
  warn("loss", state.lost > 0,
       fmt::format("{} scans of {} were lost or refused in the last second; check cable, adapter "
                   "and load",
                   state.lost, laser));
  if (state.connected && state.message != logged_) spdlog::info("reads {}", state.message);
  logged_ = state.connected ? state.message : "";
}

}  // namespace voxlist::services
