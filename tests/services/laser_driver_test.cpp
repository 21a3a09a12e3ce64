// The service on a pseudo-terminal, with a thread behind it that plays an LMS 200. Waits end when
// what is waited for is there; nothing is said of times.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>
#include <voxlist/health_t.hpp>
#include <voxlist/planar_lidar_t.hpp>

#include "services/laser_driver/laser_driver_service.h"
#include "tests/scanner/lms200/live_lms200.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"

namespace voxlist::services {
namespace {

using test::TemporaryFolder;

using namespace std::chrono_literals;

constexpr auto kPatience = 20s;

// A device in a world in which no two half turns look alike.
class Device {
 public:
  explicit Device(const std::filesystem::path& link)
      : live_(link,
              [this](std::int64_t utime_us, double angle) { return measure(utime_us, angle); }) {}

  void set_faults(const simulation::Lms200Faults& faults) { live_.set_faults(faults); }

  bool has_measured(const LaserLine& line) {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(measured_, [&](const LaserLine& m) {
      return std::ranges::equal(m.ranges_m, line.ranges_m);
    });
  }

 private:
  LaserLine measure(std::int64_t utime_us, double angle) {
    const std::lock_guard lock(mutex_);
    LaserLine line;
    line.utime_us = utime_us;
    line.first_angle_rad = angle;
    for (int beam = 0; beam < 181; ++beam)
      line.ranges_m.push_back(static_cast<float>((turn_ * 31 + beam * 7) % 8000 * 1e-3));
    ++turn_;
    measured_.push_back(line);
    return line;
  }

  std::mutex mutex_;  // of what follows
  int turn_ = 0;
  std::vector<LaserLine> measured_;
  scanner::LiveLms200 live_;
};

class LaserDriver : public testing::Test {
 protected:
  LaserDriver() {
    config_.port = (folder_ / "lms200").string();
    bus_.subscribe(bus::kLaser,
                   [this](const planar_lidar_t& m) { lines_.push_back(*bus::from_message(m)); });
  }

  // Runs the service until something holds, for as long as a loaded machine may need.
  bool run_until(const std::function<bool()>& holds) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (!holds()) {
      if (std::chrono::steady_clock::now() > end) return false;
      bus_.handle(20ms, service_->wake_fd());
      service_->tick(scanner::wall_us());
    }
    return true;
  }

  health_t health() { return *health_.due(now_us_ += 1'000'000); }

  std::int64_t counted(const std::string& name) {
    const health_t message = health();
    for (const auto& counter : message.counters)
      if (counter.name == name) return counter.count;
    return 0;
  }

  TemporaryFolder folder_;
  scanner::Lms200Config config_;
  bus::Bus bus_{{.url = "memq://", .prefix = ""}};
  bus::Health health_{"laser_driver"};
  std::int64_t now_us_ = 0;
  std::vector<LaserLine> lines_;
  std::optional<Device> device_;
  std::optional<LaserDriverService> service_;
};

TEST_F(LaserDriver, PublishesWhatTheDeviceMeasured) {
  device_.emplace(config_.port);
  service_.emplace(bus_, health_, config_);
  ASSERT_TRUE(run_until([&] { return lines_.size() >= 100; })) << health().message;
  for (const LaserLine& line : lines_) EXPECT_TRUE(device_->has_measured(line));
  ASSERT_TRUE(run_until([&] { return counted("lines") >= 100; }));
  EXPECT_EQ(counted("connections"), 1);
  EXPECT_EQ(counted("crc_errors"), 0);
}

TEST_F(LaserDriver, SaysThatThePortIsNotThereAndFindsItWhenItComes) {
  service_.emplace(bus_, health_, config_);
  ASSERT_TRUE(run_until([&] { return health().state == health_t::STATE_ERROR; }));
  EXPECT_NE(health().message.find(config_.port), std::string::npos) << health().message;
  device_.emplace(config_.port);
  EXPECT_TRUE(run_until([&] { return lines_.size() >= 10; })) << health().message;
  EXPECT_TRUE(run_until([&] { return health().state != health_t::STATE_ERROR; }));
}

TEST_F(LaserDriver, FindsADeviceThatWasUnpluggedAndPluggedIn) {
  device_.emplace(config_.port);
  service_.emplace(bus_, health_, config_);
  ASSERT_TRUE(run_until([&] { return lines_.size() >= 10; })) << health().message;
  device_.reset();
  ASSERT_TRUE(run_until([&] { return health().state == health_t::STATE_ERROR; }));
  bus_.handle(0ms);
  lines_.clear();
  device_.emplace(config_.port);
  EXPECT_TRUE(run_until([&] { return lines_.size() >= 10; })) << health().message;
  EXPECT_EQ(counted("connections"), 2);
}

TEST_F(LaserDriver, SaysWhenTheWindowIsDirtyAndBeamsAreDazzled) {
  device_.emplace(config_.port);
  device_->set_faults({.dazzle = 0.2});
  service_.emplace(bus_, health_, config_);
  const auto says = [&](const std::string& what) {
    return run_until([&] { return health().message.find(what) != std::string::npos; });
  };
  EXPECT_TRUE(says("is dazzled in")) << health().message;
  EXPECT_EQ(health().state, health_t::STATE_WARNING);
  EXPECT_GT(counted("dazzled_beams"), 0);
  device_->set_faults({.pollution = true});
  EXPECT_TRUE(says("needs its front window cleaned")) << health().message;
}

TEST_F(LaserDriver, PublishesNothingOfWhatItCannotBelieveAndSaysWhy) {
  device_.emplace(config_.port);
  service_.emplace(bus_, health_, config_);
  ASSERT_TRUE(run_until([&] { return lines_.size() >= 10; })) << health().message;
  device_->set_faults({.wrong_unit = true});
  EXPECT_TRUE(run_until([&] { return counted("refused/wrong_unit") > 0; }));
  for (const LaserLine& line : lines_) EXPECT_TRUE(device_->has_measured(line));
}

TEST_F(LaserDriver, StopsWhileTheDeviceIsSilent) {
  device_.emplace(config_.port);
  service_.emplace(bus_, health_, config_);
  ASSERT_TRUE(run_until([&] { return lines_.size() >= 10; })) << health().message;
  device_->set_faults({.silent = true});
  service_->stop();
  service_->stop();
  service_->tick(scanner::wall_us());
  service_.reset();
}

TEST_F(LaserDriver, DoesNotStartWithSettingsThatMakeNoSense) {
  config_.baud = 115'200;
  EXPECT_THROW(service_.emplace(bus_, health_, config_), std::invalid_argument);
}

}  // namespace
}  // namespace voxlist::services
