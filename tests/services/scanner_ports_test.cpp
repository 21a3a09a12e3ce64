#include "services/simulator/scanner_ports.h"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include "services/simulator/laser_faults.h"
#include "services/simulator/usb_adapter.h"
#include "tests/temporary_folder.h"
#include "voxlist/scanner/lms200/lms200_telegram.h"
#include "voxlist/serial/serial_port.h"
#include "voxlist/simulation/run/simulated_run.h"

namespace voxlist::services {
namespace {

using test::TemporaryFolder;

constexpr std::int64_t kStart_us = 1'700'000'000'000'000;
constexpr std::int64_t kSecond_us = 1'000'000;

simulation::SimulationConfig standing() {
  simulation::SimulationConfig config;
  config.scans = simulation::SimulationConfig::Scans::kNothing;
  config.stand_in_room = 0;
  return config;
}

// The scanner's ports, and a host at their other ends.
struct Host {
  explicit Host(SimulatorConfig wanted = {}) : config(std::move(wanted)) {
    config.laser_port = folder / "laser";
    config.clock_port = folder / "clock";
    ports = std::make_unique<ScannerPorts>(run.scanner(), config, kStart_us);
    laser = std::make_unique<serial::SerialPort>(config.laser_port, 9600);
    clock = std::make_unique<serial::SerialPort>(config.clock_port, 115'200);
  }

  // Lets time pass, and hears what comes.
  void serve_until(double run_s) {
    for (; now_us < kStart_us + std::llround(run_s * 1e6); now_us += 1000) {
      ports->serve(now_us);
      while (const auto received = laser->read(0)) parser.feed(now_us, received->bytes);
      while (const auto received = clock->read(0))
        text.append(received->bytes.begin(), received->bytes.end());
      while (auto event = parser.next()) events.push_back(*event);
    }
  }

  int telegrams(std::uint8_t command) const {
    int count = 0;
    for (const scanner::Lms200Event& event : events)
      count +=
          event.kind == scanner::Lms200Event::Kind::kTelegram && event.telegram.command == command;
    return count;
  }

  TemporaryFolder folder;
  SimulatorConfig config;
  simulation::SimulatedRun run{standing()};
  std::unique_ptr<ScannerPorts> ports;
  std::unique_ptr<serial::SerialPort> laser, clock;
  std::int64_t now_us = kStart_us;
  scanner::Lms200Parser parser;
  std::vector<scanner::Lms200Event> events;
  std::string text;
};

constexpr std::uint8_t kPowerOn = 0x90, kStatus = 0xB1;

void ask_for_status(Host& host) {
  host.laser->write(encode(scanner::Lms200Telegram{0x00, 0x31, {}}));
}

TEST(ScannerPorts, AreAnLms200ThatAnswersItsHost) {
  Host host;
  host.serve_until(1.0);
  EXPECT_EQ(host.telegrams(kPowerOn), 1);
  ask_for_status(host);
  host.serve_until(2.0);
  EXPECT_EQ(host.telegrams(kStatus), 1);
}

TEST(ScannerPorts, WriteALineForEachStepOfTheMotorInTheControllersMicroseconds) {
  Host host;
  host.serve_until(2.0);
  std::vector<std::int64_t> stamps;
  const char* at = host.text.data();
  const char* const end = at + host.text.size();
  while (at < end) {
    stamps.emplace_back();
    at = std::from_chars(at, end, stamps.back()).ptr;
    ASSERT_EQ(*at++, '\n');
  }
  EXPECT_NEAR(static_cast<double>(stamps.size()), 400.0, 2.0);
  for (std::size_t i = 0; i < stamps.size(); ++i)
    ASSERT_EQ(stamps[i], ScannerPorts::kControllerStart_us + static_cast<std::int64_t>(i) * 5000);
}

TEST(ScannerPorts, PutAFaultOnTheLaserWhileItsTimeLasts) {
  SimulatorConfig config;
  config.laser_fault = {.name = "silent", .from_s = 2.0, .to_s = 3.0};
  Host host(config);
  host.serve_until(2.1);
  ask_for_status(host);
  host.serve_until(3.1);
  EXPECT_EQ(host.telegrams(kStatus), 0);
  ask_for_status(host);
  host.serve_until(3.9);
  EXPECT_EQ(host.telegrams(kStatus), 1);
}

TEST(ScannerPorts, SwitchTheLaserOffAndOnOnce) {
  SimulatorConfig config;
  config.laser_fault = {.name = "power_cycle", .from_s = 2.0, .to_s = 3.0};
  Host host(config);
  host.serve_until(4.0);
  EXPECT_EQ(host.telegrams(kPowerOn), 2);
}

TEST(LaserFaults, RefuseANameThatIsNone) {
  EXPECT_THROW(LaserFaults({.name = "drop_bite"}), std::invalid_argument);
}

TEST(UsbAdapter, HoldsBytesUntilItsTimerGoesRoundOrAPacketIsFull) {
  UsbAdapter adapter(16);
  EXPECT_TRUE(adapter.given_until(160'000).empty());
  const std::vector<std::uint8_t> bytes(70, 7);
  adapter.take(bytes);
  EXPECT_EQ(adapter.given_until(161'000).size(), 62u);
  EXPECT_EQ(adapter.given_until(175'999).size(), 0u);
  EXPECT_EQ(adapter.given_until(176'000).size(), 8u);
}

TEST(UsbAdapter, GivesBytesAtOnceWithoutATimer) {
  UsbAdapter adapter(0);
  const std::vector<std::uint8_t> bytes{1, 2, 3};
  adapter.take(bytes);
  EXPECT_EQ(adapter.given_until(5), bytes);
  adapter.take(bytes);
  EXPECT_EQ(adapter.given_until(5), bytes);
}

}  // namespace
}  // namespace voxlist::services
