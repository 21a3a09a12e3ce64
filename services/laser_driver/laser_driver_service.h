#pragma once

#include <cstdint>
#include <string>

#include "services/laser_driver/laser_reader.h"

namespace voxlist::bus {
class Bus;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// Publishes each line of an LMS 200 as LASER as soon as it is there.
class LaserDriverService {
 public:
  /// Returns at once; the device is looked for behind the scenes. Throws std::invalid_argument for
  /// settings that make no sense.
  LaserDriverService(bus::Bus& bus, bus::Health& health, const scanner::Lms200Config& config);

  /// Throws std::invalid_argument for settings that the constructor would refuse.
  static void check(const scanner::Lms200Config& config);

  /// Can be read when tick() has something to do.
  int wake_fd() const { return reader_.wake_fd(); }

  /// Publishes what has come, and tells HEALTH how the device fares.
  void tick(std::int64_t now_us);

  /// Leaves the device still, within a second.
  void stop() { reader_.stop(); }

 private:
  void publish(const LaserReader::Line& line);
  void tell(const LaserReader::State& state);

  bus::Bus& bus_;
  bus::Health& health_;
  const std::string port_;
  std::int64_t told_jitter_us_ = 0;
  std::string logged_;
  LaserReader reader_;
};

}  // namespace voxlist::services
