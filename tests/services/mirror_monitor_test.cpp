#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>
#include <voxlist/health_t.hpp>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/planar_lidar_t.hpp>

#include "services/mirror_monitor/mirror_monitor_service.h"
#include "services/mirror_monitor/open_edge_source.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/serial/pseudo_terminal.h"

namespace voxlist::services {
namespace {

using test::TemporaryFolder;

constexpr std::int64_t kWall_us = 1'700'000'000'000'000;
constexpr double kDeg = std::numbers::pi / 180.0;

// A mirror of half a turn a second, its laser, and its clock on a pseudo-terminal.
struct Scanner {
  explicit Scanner(MirrorMonitorConfig config = {}) {
    if (config.clock == "none") {
      monitor.emplace(bus, health, config);
    } else {
      config.clock = "text:" + (folder / "clock").string();
      monitor.emplace(bus, health, config, [this] { return now_us(); });
    }
    bus.subscribe(bus::kMirror, [this](const mirror_state_t& m) { mirror = m; });
  }

  std::int64_t now_us() const { return kWall_us + std::llround(time_s * 1e6); }
  static double psi_rad(double at_s) { return 1.0 + std::numbers::pi * at_s; }

  planar_lidar_t line() const {
    LaserLine line{now_us(), 0.0, kDeg, std::vector<float>(181, 3.0F), {}};
    for (std::size_t i = 0; i < 181; ++i) {
      const double psi = psi_rad(time_s + beam_delay_us(line, i) * 1e-6);
      const bool first = i >= 25 && i <= 60 && std::abs(wrap_angle(psi - 90.0 * kDeg)) < 0.1;
      const bool second = i >= 120 && i <= 155 && std::abs(wrap_angle(psi - 265.0 * kDeg)) < 0.1;
      if (first || second)
        line.ranges_m[i] = static_cast<float>(0.04 / std::sin(line.angle_rad(i)));
    }
    return bus::to_message(line);
  }

  void until(double end_s) {
    for (; time_s < end_s; time_s += 1.0 / 75.03) {
      for (; static_cast<double>(edge) * 0.005 <= time_s; ++edge) {
        const std::string text = std::to_string(edge * 5000) + "\n";
        if (clock) clock->write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
      }
      bus.publish(bus::kLaser, line());
      bus.handle(std::chrono::milliseconds(0), monitor->wake_fd());
      bus.handle(std::chrono::milliseconds(0));
      monitor->tick(now_us());
    }
  }

  health_t told() { return health.due(now_us() + 10'000'000).value(); }

  std::int64_t counted(const health_t& message, const std::string& name) {
    for (const counter_t& counter : message.counters)
      if (counter.name == name) return counter.count;
    return -1;
  }

  double error_deg() const {
    const double at_s = static_cast<double>(mirror->utime - kWall_us) * 1e-6;
    return std::abs(wrap_angle(mirror->angle_rad - psi_rad(at_s))) / kDeg;
  }

  TemporaryFolder folder;
  std::optional<serial::PseudoTerminal> clock{std::in_place, folder / "clock"};
  bus::Bus bus{{.url = "memq://", .prefix = ""}};
  bus::Health health{"mirror_monitor"};
  std::optional<MirrorMonitorService> monitor;
  std::optional<mirror_state_t> mirror;
  double time_s = 0.0;
  std::int64_t edge = 0;
};

MirrorMonitorConfig with_text_clock() {
  MirrorMonitorConfig config;
  config.clock = "text:";
  return config;
}

TEST(MirrorMonitor, PublishesTheMirrorsAngleAtAnEdgeOfItsClock) {
  Scanner scanner(with_text_clock());
  scanner.until(0.3);
  ASSERT_TRUE(scanner.mirror);
  EXPECT_EQ(scanner.mirror->state, mirror_state_t::SEARCHING);
  EXPECT_NE(scanner.mirror->reason, "");
  scanner.until(60.0);
  EXPECT_EQ(scanner.mirror->state, mirror_state_t::LOCKED) << scanner.mirror->reason;
  EXPECT_TRUE(scanner.mirror->angle_known);
  EXPECT_LT(scanner.error_deg(), 0.1);
  EXPECT_NEAR(scanner.mirror->rate_radps, std::numbers::pi, 0.002);
  EXPECT_NEAR(scanner.mirror->step_rad, 0.9 * kDeg, 1e-9);
  const health_t health = scanner.told();
  EXPECT_EQ(health.state, health_t::STATE_OK) << health.message;
  EXPECT_GT(scanner.counted(health, "edges"), 11'900);
  EXPECT_EQ(scanner.counted(health, "lost_edges"), 0);
  EXPECT_EQ(scanner.counted(health, "clock_restarts"), 0);
  EXPECT_NEAR(static_cast<double>(scanner.counted(health, "arm_events")), 60.0, 1.0);
  EXPECT_NEAR(static_cast<double>(scanner.counted(health, "clock_period_us")), 5000.0, 5.0);
}

TEST(MirrorMonitor, NeedsNoClock) {
  Scanner scanner;
  EXPECT_EQ(scanner.monitor->wake_fd(), -1);
  scanner.until(60.0);
  EXPECT_EQ(scanner.mirror->state, mirror_state_t::LOCKED) << scanner.mirror->reason;
  EXPECT_LT(scanner.error_deg(), 0.2);
  EXPECT_EQ(scanner.mirror->step_rad, 0.0);
}

TEST(MirrorMonitor, GoesOnWithTheArmsWhenItsClockIsUnplugged) {
  Scanner scanner(with_text_clock());
  scanner.until(30.0);
  scanner.clock.reset();
  scanner.until(40.0);
  EXPECT_EQ(scanner.mirror->state, mirror_state_t::FAULT);
  EXPECT_TRUE(scanner.mirror->angle_known);
  EXPECT_LT(scanner.error_deg(), 0.5);
  const health_t health = scanner.told();
  EXPECT_EQ(health.state, health_t::STATE_WARNING);
  EXPECT_NE(health.message.find("clock at "), std::string::npos) << health.message;
  scanner.clock.emplace(scanner.folder / "clock");
  scanner.until(60.0);
  EXPECT_EQ(scanner.mirror->state, mirror_state_t::LOCKED) << scanner.mirror->reason;
  EXPECT_EQ(scanner.told().state, health_t::STATE_OK);
}

TEST(MirrorMonitor, WaitsForItsClockAndForTheLaser) {
  Scanner scanner(with_text_clock());
  scanner.clock.reset();
  scanner.monitor->tick(0);
  EXPECT_NE(scanner.told().message.find("No such file"), std::string::npos);
  Scanner silent;
  silent.monitor->tick(0);
  EXPECT_NE(silent.told().message.find("no LASER"), std::string::npos);
}

TEST(MirrorMonitor, CountsLinesThatMakeNoSense) {
  Scanner scanner;
  planar_lidar_t line = scanner.line();
  line.utime = -1;
  scanner.bus.publish(bus::kLaser, line);
  scanner.bus.handle(std::chrono::milliseconds(0));
  EXPECT_FALSE(scanner.mirror);
  EXPECT_EQ(scanner.counted(scanner.told(), "LASER/bad_line"), 1);
}

TEST(MirrorMonitor, DoesNotStartWithSettingsThatMakeNoSense) {
  MirrorMonitorConfig none, three, uneven, narrow, nowhere;
  none.arm_angle_deg.clear();
  three.arm_angle_deg = {1.0, 2.0, 3.0};
  uneven.arm_last_beam_deg = {60.0};
  narrow.arm_last_beam_deg = {26.0, 155.0};
  for (const MirrorMonitorConfig& config : {none, three, uneven, narrow})
    EXPECT_THROW(Scanner{config}, std::invalid_argument);
  for (const char* where : {"", "gpio", "gpio:17", "gpio:chip/x", "modem:/dev/ttyS0",
                            "modem:/dev/ttyS0:abc", "text:", "text:/dev/x@fast", "usb"}) {
    EXPECT_THROW(open_edge_source(where, {}), std::invalid_argument) << where;
  }
}

TEST(MirrorMonitor, SaysWhatIsWrongWithAPinThatIsNotThere) {
  const auto source = open_edge_source("gpio:gpiochip_of_nobody/17", {});
  EXPECT_TRUE(source->read(0).empty());
  EXPECT_NE(source->trouble().find("gpiochip_of_nobody/17"), std::string::npos);
}

}  // namespace
}  // namespace voxlist::services
