// Real ranges through the device double and the session: what went in comes out.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>

#include "tests/scanner/lms200/carmen_log.h"
#include "tests/scanner/lms200/live_lms200.h"
#include "tests/scanner/lms200/lms200_bench.h"
#include "voxlist/scanner/lms200/lms200.h"
#include "voxlist/serial/serial_port.h"

namespace voxlist::scanner {
namespace {

constexpr std::int64_t kStart_us = 1'700'000'000'000'000;

// Nothing came back: the log's word for it, as the device's is in centimetres.
constexpr float kNoRange_m = 81.9F;

// Plays the log's scans: those of half a degree as the two partial scans that they are.
class Player {
 public:
  explicit Player(const std::vector<std::vector<float>>& scans) : scans_(scans) {}

  LaserLine measure(std::int64_t utime_us, double first_angle_rad) {
    const bool odd = first_angle_rad > 0.1 * std::numbers::pi / 180.0;
    if (!odd && begun_) ++scan_;
    begun_ = true;
    LaserLine line;
    line.utime_us = utime_us;
    line.first_angle_rad = first_angle_rad;
    const std::vector<float>& scan = scans_[scan_ % scans_.size()];
    for (std::size_t beam = odd ? 1 : 0; beam < scan.size(); beam += 2)
      line.ranges_m.push_back(scan[beam] < kNoRange_m ? scan[beam] : NAN);
    line.ranges_m.resize(181, NAN);
    played_.push_back(line);
    return line;
  }

  bool is_over() const { return scan_ + 1 >= scans_.size(); }

  // What went in, in order.
  std::vector<LaserLine> take() { return std::exchange(played_, {}); }

 private:
  const std::vector<std::vector<float>>& scans_;
  std::size_t scan_ = 0;
  bool begun_ = false;
  std::vector<LaserLine> played_;
};

long millimetres(float range_m) { return std::lround(range_m * 1e3F); }

struct Comparison {
  int lines = 0, ranges = 0, wrong = 0, beyond = 0, none = 0;

  // `limit_m`: the device has no greater ranges.
  void add(const LaserLine& out, const LaserLine& in, double limit_m) {
    ++lines;
    for (std::size_t i = 0; i < out.ranges_m.size(); ++i) {
      const float range_m = in.ranges_m[i];
      ++ranges;
      if (std::isnan(range_m)) {
        ++none;
        wrong += !std::isnan(out.ranges_m[i]);
      } else if (range_m >= limit_m) {
        ++beyond;
        wrong += !(out.ranges_m[i] == std::numeric_limits<float>::infinity());
      } else {
        wrong += millimetres(out.ranges_m[i]) != millimetres(range_m);
      }
    }
  }

  void print(double limit_m) const {
    std::cout << lines << " lines, " << ranges << " ranges, " << none << " without, " << beyond
              << " beyond " << limit_m << " m, " << wrong << " wrong\n";
  }
};

// How many lines were measured before the last one that came; the first few are left out.
std::size_t number_of_last(const Lms200& driver) {
  const Lms200Report report = driver.report();
  std::int64_t number = report.lines - 1;
  for (const auto& [reason, count] : report.refused) number += count;
  return static_cast<std::size_t>(number);
}

class Carmen : public testing::Test {
 protected:
  void SetUp() override {
    scans_ = carmen_scans();
    if (scans_.empty()) GTEST_SKIP() << "no carmen/fr079.clf.bz2 in VOXLIST_DATA, or no bzcat";
  }

  Comparison compare(const Lms200Config& config, double limit_m) {
    Player player(scans_);
    simulation::Lms200Device device(
        {.power_on_s = 0.0}, kStart_us,
        [&](auto utime_us, double angle) { return player.measure(utime_us, angle); });
    VirtualPort port(device, kStart_us);
    Lms200 driver(port, config);
    driver.begin();
    Comparison result;
    std::vector<LaserLine> waiting;
    while (!player.is_over()) {
      const auto line = driver.next(1'000'000);
      for (LaserLine& played : player.take()) waiting.push_back(std::move(played));
      if (!line) break;
      result.add(*line, waiting[number_of_last(driver)], limit_m);
    }
    EXPECT_EQ(driver.report().lost_scans, 0);
    result.print(limit_m);
    return result;
  }

  std::vector<std::vector<float>> scans_;
};

TEST_F(Carmen, RangesComeThroughARealPseudoTerminalAsTheyWentIn) {
  constexpr int kSpeed = 10;
  constexpr int kLines = 1000;
  const auto link =
      std::filesystem::temp_directory_path() / ("voxlist_carmen_" + std::to_string(getpid()));
  Player player(scans_);
  std::mutex mutex;
  std::vector<LaserLine> waiting;
  LiveLms200 device(
      link,
      [&](std::int64_t utime_us, double angle) {
        const std::lock_guard lock(mutex);
        LaserLine line = player.measure(utime_us, angle);
        waiting.push_back(line);
        return line;
      },
      kSpeed);
  serial::SerialPort port(link, 9600);
  Lms200Config config;
  config.port = link;
  config.range_m = 80;
  config.resolution_deg = 0.5;
  Lms200 driver(port, config);
  driver.begin();
  Comparison result;
  for (int i = 0; i < kLines; ++i) {
    const auto line = driver.next(1'000'000);
    ASSERT_TRUE(line) << i;
    const std::lock_guard lock(mutex);
    result.add(*line, waiting[number_of_last(driver)], 81.83);
  }
  driver.end();
  std::cout << "pseudo-terminal, " << kSpeed << " times real time: ";
  result.print(81.83);
  EXPECT_EQ(driver.report().damaged, 0);
  EXPECT_EQ(result.wrong, 0);
}

TEST_F(Carmen, RangesInCentimetresComeOutAsTheyWentIn) {
  Lms200Config config;
  config.range_m = 80;
  config.resolution_deg = 0.5;
  const Comparison result = compare(config, 81.83);
  EXPECT_GT(result.lines, 9'000);
  EXPECT_EQ(result.wrong, 0);
}

TEST_F(Carmen, RangesInMillimetresComeOutAsTheyWentInUpTo8Metres) {
  const Comparison result = compare(Lms200Config{}, 8.183);
  EXPECT_GT(result.lines, 4'000);
  EXPECT_GT(result.beyond, 10'000);
  EXPECT_EQ(result.wrong, 0);
}

}  // namespace
}  // namespace voxlist::scanner
