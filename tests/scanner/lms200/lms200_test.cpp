#include "voxlist/scanner/lms200/lms200.h"

#include <gtest/gtest.h>

#include <functional>
#include <iostream>
#include <memory>
#include <numbers>
#include <string>

#include "tests/scanner/lms200/lms200_bench.h"

namespace voxlist::scanner {
namespace {

constexpr std::int64_t kStart_us = 1'700'000'000'000'000;
constexpr std::int64_t kSecond_us = 1'000'000;

// A driver on a simulated device, in virtual time.
class Lms200Session : public testing::Test {
 protected:
  void plug_in(const simulation::Lms200Device::Config& device, double jitter_us = 1000.0) {
    device_ = std::make_unique<simulation::Lms200Device>(
        device, kStart_us,
        [this](std::int64_t utime_us, double angle) { return world_.measure(utime_us, angle); });
    port_ = std::make_unique<VirtualPort>(*device_, kStart_us, jitter_us);
    driver_ = std::make_unique<Lms200>(*port_, config_);
    running_ = false;
  }

  // As a service does: for ever, and anew after each failure.
  void run_for(double seconds) {
    const std::int64_t end_us = port_->now_us() + std::llround(seconds * 1e6);
    while (port_->now_us() < end_us) try {
        if (!running_) driver_->begin();
        running_ = true;
        if (const auto line = driver_->next(50'000)) take(*line);
      } catch (const std::runtime_error& error) {
        running_ = false;
        ++failures_;
        last_failure_ = error.what();
        port_->read(200'000);
      }
  }

  void take(const LaserLine& line) {
    ++lines_;
    last_line_us_ = port_->now_us();
    if (recovered_us_ == 0) recovered_us_ = last_line_us_;
    const LaserLine* truth = world_.shown_by(line);
    if (truth == nullptr) {
      ++wrong_lines_;
    } else {
      const std::int64_t true_us = truth->utime_us + port_->clock_set_us;
      worst_us_ = std::max(worst_us_, std::abs(line.utime_us - true_us));
    }
  }

  // Runs well, then with a fault, then without it. Returns how long the first line took that came
  // after the fault.
  double seconds_to_recover(double fault_s, const std::function<void()>& fault,
                            const std::function<void()>& mend) {
    plug_in({.power_on_s = 0.0});
    run_for(3.0);
    EXPECT_LT(port_->now_us() - last_line_us_, 50'000) << last_failure_;
    fault();
    run_for(fault_s);
    mend();
    recovered_us_ = 0;
    const std::int64_t mended_us = port_->now_us();
    run_for(4.0);
    EXPECT_NE(recovered_us_, 0) << last_failure_;
    EXPECT_LT(port_->now_us() - last_line_us_, 50'000) << last_failure_;
    return static_cast<double>(recovered_us_ - mended_us) * 1e-6;
  }

  // The longest that it takes, by when the fault ends.
  void expect_recovery(const std::string& name, const simulation::Lms200Faults& faults) {
    double worst_s = 0.0;
    lines_ = wrong_lines_ = failures_ = 0;
    for (const double fault_s : {0.4, 1.1, 2.5, 3.2, 3.9, 4.6, 9.3}) {
      const double seconds = seconds_to_recover(
          fault_s, [&] { device_->set_faults(faults); }, [&] { device_->set_faults({}); });
      worst_s = std::max(worst_s, seconds);
    }
    std::cout << name << ": back within " << worst_s << " s; " << failures_ << " new sessions, "
              << wrong_lines_ << " wrong of " << lines_ << " lines\n";
    EXPECT_LT(worst_s, 3.0) << name;
    EXPECT_EQ(wrong_lines_, 0) << name;
  }

  Lms200Config config_;
  Lms200World world_;
  std::unique_ptr<simulation::Lms200Device> device_;
  std::unique_ptr<VirtualPort> port_;
  std::unique_ptr<Lms200> driver_;
  bool running_ = false;
  int lines_ = 0, wrong_lines_ = 0, failures_ = 0;
  std::int64_t last_line_us_ = 0, recovered_us_ = 0, worst_us_ = 0;
  std::string last_failure_;
};

TEST_F(Lms200Session, FindsTheDeviceAtEverySpeed) {
  for (const int baud : {9600, 19200, 38400, 500'000}) {
    plug_in({.baud = baud, .power_on_s = 0.0});
    driver_->begin();
    EXPECT_EQ(device_->baud(), 500'000) << baud;
    EXPECT_TRUE(driver_->next(kSecond_us)) << baud;
    EXPECT_EQ(driver_->report().type, "LMS200;301063;V02.06");
  }
}

TEST_F(Lms200Session, FindsADeviceThatACrashLeftStreaming) {
  for (const int baud : {9600, 19200, 38400, 500'000}) {
    plug_in({.baud = baud, .power_on_s = 0.0, .streams_at_start = true});
    run_for(10.0);
    EXPECT_EQ(device_->baud(), 500'000) << baud;
    EXPECT_LT(port_->now_us() - last_line_us_, 50'000) << baud << ": " << last_failure_;
    EXPECT_EQ(wrong_lines_, 0);
  }
}

TEST_F(Lms200Session, WaitsForADeviceThatStartsUp) {
  for (const double power_on_s : {0.3, 1.7, 12.3, 31.0}) {
    config_.power_on_wait_s = 60.0;
    plug_in({.power_on_s = power_on_s});
    driver_->begin();
    const double after_s = static_cast<double>(port_->now_us() - kStart_us) * 1e-6 - power_on_s;
    std::cout << "power-on after " << power_on_s << " s: streams " << after_s << " s later\n";
    EXPECT_LT(after_s, 3.0);
    EXPECT_TRUE(driver_->next(kSecond_us));
  }
}

TEST_F(Lms200Session, SaysWhatToDoWhenNothingAnswers) {
  config_.port = "/dev/ttyUSB7";
  plug_in({.power_on_s = 100.0});
  try {
    driver_->begin();
    FAIL();
  } catch (const Lms200Failure& failure) {
    EXPECT_TRUE(failure.is_silent);
    EXPECT_STREQ(
        failure.what(),
        "no LMS 200 answers on /dev/ttyUSB7 at any speed; check its power (it starts in up "
        "to 60 s), its cable (500 kbaud needs RS-422) and the port's name");
  }
  EXPECT_NEAR(static_cast<double>(port_->now_us() - kStart_us) * 1e-6, config_.power_on_wait_s, 2);
}

TEST_F(Lms200Session, WritesTheConfigurationOnceAndOnlyWhenItDiffers) {
  for (const bool long_one : {true, false}) {
    plug_in({.power_on_s = 0.0, .long_configuration = long_one});
    for (int i = 0; i < 3; ++i) {
      driver_->begin();
      EXPECT_EQ(device_->configuration_writes(), 1);
      driver_->end();
    }
    device_->power_cycle(port_->now_us());
    Lms200(*port_, config_).begin();
    EXPECT_EQ(device_->configuration_writes(), 1);
  }
}

TEST_F(Lms200Session, SetsUpADeviceWhoseLineIsDamagedAtFirst) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u}) {
    plug_in({.power_on_s = 0.0, .seed = seed});
    device_->set_faults({.drop_byte = 0.003, .corrupt_byte = 0.003});
    run_for(8.0);
    device_->set_faults({.silent = true});
    run_for(2.0);
    device_->set_faults({});
    run_for(3.0);
    EXPECT_LT(port_->now_us() - last_line_us_, 50'000) << seed << ": " << last_failure_;
    EXPECT_LE(device_->configuration_writes(), 3);
    EXPECT_EQ(wrong_lines_, 0);
  }
}

TEST_F(Lms200Session, LeavesTheConfigurationAloneWhenToldSo) {
  config_.write_configuration = false;
  plug_in({.power_on_s = 0.0});
  run_for(5.0);
  EXPECT_EQ(device_->configuration_writes(), 0);
  EXPECT_GT(lines_, 200) << last_failure_;
  EXPECT_EQ(driver_->report().lost_scans, 0);
}

TEST_F(Lms200Session, LosesNothingInTenMinutes) {
  plug_in({.power_on_s = 0.0});
  run_for(600.0);
  const Lms200Report report = driver_->report();
  EXPECT_GT(lines_, 44'850);
  EXPECT_EQ(lines_, report.lines);
  EXPECT_EQ(report.lost_scans, 0);
  EXPECT_EQ(report.damaged, 0);
  EXPECT_EQ(report.clock_jumps, 0);
  EXPECT_EQ(report.refused, (std::map<std::string, std::int64_t>{{"line_in_doubt", 15}}));
  EXPECT_EQ(failures_, 0) << last_failure_;
  EXPECT_EQ(wrong_lines_, 0);
  EXPECT_NEAR(report.turns_per_second, 75.03, 0.001);
  EXPECT_LT(worst_us_, 1000);
  std::cout << lines_ << " lines, worst time stamp " << worst_us_ << " us off, jitter "
            << report.jitter_us << " us\n";
}

TEST_F(Lms200Session, StampsWithinAMillisecondThroughAnAdapterOf16Milliseconds) {
  plug_in({.power_on_s = 0.0}, 16'000.0);
  run_for(6.0);
  worst_us_ = 0;
  run_for(30.0);
  std::cout << "16 ms adapter: worst time stamp " << worst_us_ << " us off\n";
  EXPECT_LT(worst_us_, 1000);
  EXPECT_EQ(driver_->report().lost_scans, 0);
}

TEST_F(Lms200Session, ReadsFinerResolutionsAsPartialScans) {
  for (const double resolution_deg : {0.5, 0.25}) {
    config_.resolution_deg = resolution_deg;
    plug_in({.power_on_s = 0.0});
    driver_->begin();
    const int partials = static_cast<int>(1.0 / resolution_deg);
    std::vector<int> seen(4);
    for (int i = 0; i < 100; ++i) {
      const auto line = driver_->next(kSecond_us);
      ASSERT_TRUE(line);
      const LaserLine* truth = world_.shown_by(*line);
      ASSERT_NE(truth, nullptr);
      const double quarters = line->first_angle_rad / (std::numbers::pi / 720.0);
      ++seen[static_cast<std::size_t>(std::lround(quarters))];
      EXPECT_EQ(line->ranges_m.size(), quarters < 0.5 ? 181u : 180u);
      EXPECT_NEAR(line->step_rad, std::numbers::pi / 180.0, 1e-9);
    }
    for (std::size_t p = 0; p < 4; ++p)
      EXPECT_EQ(seen[p] > 0, p % (4 / static_cast<std::size_t>(partials)) == 0) << p;
    EXPECT_EQ(driver_->report().lost_scans, 0);
  }
}

TEST_F(Lms200Session, MeasuresFarWhenAskedTo) {
  config_.range_m = 80;
  plug_in({.power_on_s = 0.0});
  driver_->begin();
  const auto line = driver_->next(kSecond_us);
  ASSERT_TRUE(line);
  for (const float range_m : line->ranges_m) EXPECT_TRUE(std::isfinite(range_m));
}

TEST_F(Lms200Session, WorksOnASlowLine) {
  config_.baud = 38400;
  plug_in({.power_on_s = 0.0});
  run_for(30.0);
  EXPECT_GT(lines_, 230);
  EXPECT_EQ(wrong_lines_, 0);
  EXPECT_EQ(driver_->report().lost_scans, 0);
  EXPECT_EQ(driver_->report().clock_jumps, 0);
  EXPECT_LT(worst_us_, 2000);
}

TEST_F(Lms200Session, RecoversFromEveryFaultWithoutOneWrongRange) {
  expect_recovery("dropped bytes", {.drop_byte = 0.003});
  expect_recovery("corrupt bytes", {.corrupt_byte = 0.003});
  expect_recovery("noise", {.noise_byte = 0.003});
  expect_recovery("all bytes corrupt", {.corrupt_byte = 0.5});
  expect_recovery("nothing but noise", {.drop_byte = 0.9, .noise_byte = 0.9});
  expect_recovery("refusals", {.refuse = true});
  expect_recovery("refusals among damage", {.corrupt_byte = 0.2, .refuse = true});
  expect_recovery("silence", {.silent = true});
  expect_recovery("answers from 81", {.address_81 = true});
  expect_recovery("wrong unit", {.wrong_unit = true});
  expect_recovery("partial bits", {.partial_bits = true});
  expect_recovery("pollution", {.pollution = true});
  expect_recovery("dazzle", {.dazzle = 0.3});
  expect_recovery("over maximum", {.over_max = 0.3});
}

TEST_F(Lms200Session, FindsADeviceThatWasSwitchedOffAndOn) {
  for (const double gone_s : {0.1, 0.5, 1.2}) {
    const double seconds = seconds_to_recover(
        gone_s, [&] { device_->power_cycle(port_->now_us()); }, [] {});
    std::cout << "power cycle: back " << seconds << " s later\n";
    EXPECT_LT(seconds, 3.0);
    EXPECT_EQ(wrong_lines_, 0);
  }
}

TEST_F(Lms200Session, GoesOnWhenTheClockIsSet) {
  constexpr std::int64_t kHour_us = 3600 * kSecond_us;
  for (const std::int64_t set_us : {-kHour_us, kHour_us}) {
    plug_in({.power_on_s = 0.0});
    run_for(5.0);
    port_->clock_set_us = set_us;
    run_for(4.0);
    worst_us_ = 0;
    run_for(4.0);
    EXPECT_EQ(failures_, 0) << last_failure_;
    EXPECT_EQ(driver_->report().clock_jumps, 1);
    EXPECT_LT(worst_us_, 1000);
    EXPECT_LT(port_->now_us() - last_line_us_, 50'000);
  }
}

TEST_F(Lms200Session, GoesOnWithDamagedScansLeftOut) {
  plug_in({.power_on_s = 0.0});
  run_for(3.0);
  device_->set_faults({.corrupt_byte = 0.00005});
  run_for(60.0);
  const Lms200Report report = driver_->report();
  EXPECT_EQ(failures_, 0) << last_failure_;
  EXPECT_EQ(wrong_lines_, 0);
  EXPECT_GT(report.damaged, 50);
  EXPECT_GT(report.lost_scans, 50);
  EXPECT_NEAR(static_cast<double>(report.lines + report.lost_scans), 75.03 * 62.0, 75.0);
  EXPECT_LT(worst_us_, 1000);
}

TEST_F(Lms200Session, BelievesNoScanWhileTheLineDamagesManyForTheCrcIsWeak) {
  plug_in({.power_on_s = 0.0});
  run_for(3.0);
  device_->set_faults({.corrupt_byte = 0.001});
  run_for(1.0);
  lines_ = 0;
  run_for(300.0);
  std::cout << lines_ << " lines of a line that damages every third\n";
  EXPECT_LT(lines_, 200);
  EXPECT_EQ(wrong_lines_, 0);
  EXPECT_GT(driver_->report().refused.at("line_in_doubt"), 10'000);
}

TEST_F(Lms200Session, LosesNothingWhenItIsKeptFromReading) {
  plug_in({.power_on_s = 0.0});
  run_for(5.0);
  for (int i = 0; i < 20; ++i) {
    port_->sleep(50'000 * (i + 1));
    run_for(0.517);
  }
  EXPECT_EQ(failures_, 0) << last_failure_;
  const Lms200Report report = driver_->report();
  EXPECT_EQ(report.damaged, 0);
  EXPECT_EQ(report.lost_scans, 0);
  EXPECT_EQ(report.clock_jumps, 0);
  EXPECT_LT(worst_us_, 1000);
}

TEST_F(Lms200Session, CountsDazzledBeamsAndSeesPollution) {
  plug_in({.power_on_s = 0.0});
  run_for(3.0);
  device_->set_faults({.pollution = true, .dazzle = 0.1});
  run_for(3.0);
  const Lms200Report report = driver_->report();
  EXPECT_NEAR(static_cast<double>(report.dazzled_beams), 225 * 18.1, 400);
  EXPECT_TRUE(report.polluted);
}

TEST_F(Lms200Session, SaysWhyScansAreRefused) {
  plug_in({.power_on_s = 0.0});
  run_for(3.0);
  device_->set_faults({.wrong_unit = true});
  run_for(1.1);
  EXPECT_EQ(last_failure_,
            "the LMS 200 on /dev/ttyUSB0 sends scans that make no sense (wrong_unit)");
  EXPECT_GT(driver_->report().refused.at("wrong_unit"), 60);
}

TEST_F(Lms200Session, LeavesTheDeviceStillAndAt9600) {
  plug_in({.power_on_s = 0.0});
  run_for(2.0);
  const std::int64_t before_us = port_->now_us();
  driver_->end();
  EXPECT_LT(port_->now_us() - before_us, kSecond_us);
  EXPECT_EQ(device_->baud(), 9600);
  port_->read(100'000);
  EXPECT_FALSE(port_->read(kSecond_us));
}

TEST_F(Lms200Session, EndsInTimeWhenNothingAnswers) {
  plug_in({.power_on_s = 0.0});
  run_for(2.0);
  device_->set_faults({.silent = true});
  const std::int64_t before_us = port_->now_us();
  driver_->end();
  EXPECT_LT(port_->now_us() - before_us, kSecond_us);
  port_->device_gone = true;
  driver_->end();
}

TEST_F(Lms200Session, RefusesAConfigThatMakesNoSense) {
  plug_in({});
  const auto refused = [&](const Lms200Config& config) {
    EXPECT_THROW(Lms200(*port_, config), std::invalid_argument);
  };
  refused({.port = ""});
  refused({.baud = 115200});
  refused({.resolution_deg = 0.3});
  refused({.range_m = 20});
}

}  // namespace
}  // namespace voxlist::scanner
