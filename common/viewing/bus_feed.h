#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace voxlist::bus {
class Bus;
}

namespace voxlist::viewing {

class RobotScene;

/// Hands what a bus says of the robot to a scene. The map's changes are for the owner to bring, who
/// knows whom to believe.
class BusFeed {
 public:
  /// `robots`: names of those whose floor plans are shown. Bus and scene must outlive it.
  BusFeed(bus::Bus& bus, RobotScene& scene, const std::vector<std::string>& robots);

  /// The time of what comes from here on (us).
  void set_time(std::int64_t now_us) { now_us_ = now_us; }

 private:
  std::int64_t now_us_ = 0;
};

}  // namespace voxlist::viewing
