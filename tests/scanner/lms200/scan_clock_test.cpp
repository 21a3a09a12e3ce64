#include "voxlist/scanner/lms200/scan_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "voxlist/simulation/random.h"

namespace voxlist::scanner {
namespace {

constexpr double kStart_us = 1.7e15;
constexpr double kDelay_us = 6700.0;

// A laser whose mirror turns at its own rate, and a line that holds up what it sends.
struct Laser {
  double turns_per_second = 75.03;
  double lost = 0.0;         // probability that a scan gets lost
  bool loss_is_told = true;  // the stream shows that there was one
  double jitter_us = 16'000.0;
  double stall = 0.0;  // probability that the line stops
  double stall_us = 100'000.0;
  int turns_per_scan = 1;
  bool index = true;
  std::uint64_t seed = 1;

  simulation::Random random{seed};
  std::int64_t turn = 0;
  double first_beam_us = kStart_us;
  double arrived_us = 0.0, stalled_until_us = 0.0;
  int lost_before = 0;

  // The next scan that comes.
  void turn_on() {
    lost_before = -1;
    do {
      ++lost_before;
      turn += turns_per_scan;
      first_beam_us += 1e6 / turns_per_second * turns_per_scan;
    } while (random.uniform(0.0, 1.0) < lost);
    const double sent_us = first_beam_us + kDelay_us;
    if (random.uniform(0.0, 1.0) < stall) stalled_until_us = sent_us + stall_us;
    arrived_us = std::max({arrived_us, stalled_until_us, sent_us + random.uniform(0.0, jitter_us)});
  }

  // Error of the clock's time of the scan (us).
  double error_us(ScanClock& clock, double clock_set_us = 0.0) {
    const auto turn_index = static_cast<std::uint8_t>(turn & 0xFF);
    const std::int64_t stamp_us = clock.first_beam_utime_us(
        std::llround(arrived_us + clock_set_us), index ? std::optional(turn_index) : std::nullopt,
        loss_is_told ? lost_before : 0);
    return static_cast<double>(stamp_us) - first_beam_us - clock_set_us;
  }

  double seconds() const { return (first_beam_us - kStart_us) / 1e6; }
};

double percentile(std::vector<double> values, double percent) {
  std::ranges::sort(values);
  const auto n = static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(n * percent / 100.0)];
}

ScanClockConfig config() { return {.delay_us = kDelay_us}; }

// Absolute errors from 2 s after the start to `seconds`.
std::vector<double> errors_us(Laser laser, ScanClock& clock, double seconds) {
  std::vector<double> errors;
  while (laser.seconds() < seconds) {
    laser.turn_on();
    const double error = std::abs(laser.error_us(clock));
    if (laser.seconds() > 2.0) errors.push_back(error);
  }
  return errors;
}

void print(const std::string& what, const std::vector<double>& errors) {
  std::cout << what << ": " << errors.size() << " time stamps, error p50 " << percentile(errors, 50)
            << ", p99 " << percentile(errors, 99) << ", max " << percentile(errors, 100) << " us\n";
}

TEST(ScanClock, IsWithinAMillisecondUnder16MillisecondsOfJitterAndOnePercentLost) {
  for (const bool index : {true, false}) {
    for (const double rate : {74.925, 75.0, 75.03, 75.075}) {
      ScanClock clock(config());
      const auto errors =
          errors_us({.turns_per_second = rate, .lost = 0.01, .index = index}, clock, 60.0);
      print(std::to_string(rate) + " Hz, " + (index ? "index" : "no index"), errors);
      EXPECT_LT(percentile(errors, 99), 1000.0);
      EXPECT_NEAR(clock.turn_us(), 1e6 / rate, 1.0);
      EXPECT_NEAR(clock.jitter_us(), 15'840.0, 400.0);
      EXPECT_EQ(clock.jumps(), 0);
    }
  }
}

TEST(ScanClock, IsWithinAMillisecondSoonAfterTheStart) {
  std::vector<double> errors;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    ScanClock clock(config());
    const auto run = errors_us({.lost = 0.01, .seed = seed}, clock, 4.0);
    errors.insert(errors.end(), run.begin(), run.end());
  }
  print("2 to 4 s after 50 starts", errors);
  EXPECT_LT(percentile(errors, 99), 1000.0);
}

TEST(ScanClock, FollowsAMotorThatDrifts) {
  Laser laser;
  ScanClock clock(config());
  std::vector<double> errors;
  while (laser.seconds() < 120.0) {
    laser.turns_per_second = 75.0 + 0.0006 * laser.seconds();
    laser.turn_on();
    const double error = std::abs(laser.error_us(clock));
    if (laser.seconds() > 2.0) errors.push_back(error);
  }
  print("0.1 % of drift in two minutes", errors);
  EXPECT_LT(percentile(errors, 99), 1000.0);
  EXPECT_EQ(clock.jumps(), 0);
}

TEST(ScanClock, IsNotMovedByStallsOfTheLine) {
  for (const bool index : {true, false}) {
    for (const double stall_us : {100'000.0, 2'500'000.0}) {
      ScanClock clock(config());
      const double often = 500.0 / stall_us;
      const auto errors =
          errors_us({.jitter_us = 1000.0, .stall = often, .stall_us = stall_us, .index = index},
                    clock, 120.0);
      print("stalls of " + std::to_string(stall_us) + " us", errors);
      EXPECT_LT(percentile(errors, 100), 500.0);
      EXPECT_EQ(clock.lost_scans(), 0);
      EXPECT_EQ(clock.jumps(), 0);
    }
  }
}

TEST(ScanClock, CountsWhatTheIndexMissesThoughTheStreamShowsNothing) {
  Laser laser{.lost = 0.05, .loss_is_told = false};
  ScanClock clock(config());
  std::int64_t lost = 0;
  for (int i = 0; i < 3000; ++i) {
    laser.turn_on();
    if (i > 0) lost += laser.lost_before;
    laser.error_us(clock);
  }
  EXPECT_GT(lost, 100);
  EXPECT_EQ(clock.lost_scans(), lost);
}

TEST(ScanClock, NoticesALossThatNothingTold) {
  Laser laser{.loss_is_told = false, .index = false};
  ScanClock clock(config());
  double error = 0.0;
  for (int i = 0; i < 1000; ++i) {
    laser.lost = 0.0;
    laser.turn_on();
    if (i == 600) laser.turn_on();
    error = laser.error_us(clock);
    const bool known = i < 600 || i > 620;
    if (i > 400 && known) {
      EXPECT_LT(std::abs(error), 1000.0) << i;
    }
  }
  EXPECT_EQ(clock.lost_scans(), 1);
  EXPECT_EQ(clock.jumps(), 0);
}

TEST(ScanClock, BeginsAnewWhenTheClockIsSet) {
  for (const double set_us : {-3.6e9, -50'000.0, 50'000.0, 400'000.0, 7.2e9}) {
    Laser laser;
    ScanClock clock(config());
    for (int i = 0; i < 1500; ++i) {
      laser.turn_on();
      laser.error_us(clock);
    }
    std::vector<double> errors;
    for (int i = 0; i < 900; ++i) {
      laser.turn_on();
      const double error = std::abs(laser.error_us(clock, set_us));
      if (i > 450) errors.push_back(error);
    }
    print("clock set by " + std::to_string(set_us) + " us", errors);
    EXPECT_LT(percentile(errors, 99), 1000.0);
    EXPECT_EQ(clock.jumps(), 1);
    EXPECT_EQ(clock.lost_scans(), 0);
  }
}

TEST(ScanClock, KeepsToTheGridOnASlowLine) {
  for (const bool index : {true, false}) {
    ScanClockConfig slow = config();
    slow.turns_per_scan = 8;
    slow.window_s = 60.0;
    ScanClock clock(slow);
    const auto errors = errors_us(
        {.lost = 0.01, .jitter_us = 2000.0, .turns_per_scan = 8, .index = index}, clock, 120.0);
    print("38400 baud", errors);
    EXPECT_LT(percentile(errors, 99), 1000.0);
    EXPECT_EQ(clock.jumps(), 0);
  }
}

TEST(ScanClock, DoesNotTrustAnIndexThatStandsStill) {
  Laser laser;
  ScanClock clock(config());
  double error = 0.0;
  for (int i = 0; i < 1500; ++i) {
    laser.turn_on();
    const std::int64_t stamp_us = clock.first_beam_utime_us(std::llround(laser.arrived_us), 7);
    error = static_cast<double>(stamp_us) - laser.first_beam_us;
  }
  EXPECT_LT(std::abs(error), 1000.0);
}

}  // namespace
}  // namespace voxlist::scanner
