#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tests/soak/answers.h"
#include "tests/soak/laps.h"
#include "tests/soak/watch.h"
#include "voxlist/bus/bus.h"

namespace voxlist::soak {

/// A minute of the robot's time.
struct Minute {
  Answers answers;
  std::map<std::string, ServiceTime> services;
  double wall_s = 0.0;
  std::int64_t keyframes = 0;  ///< of the map, at its end
  int late = 0;                ///< times that the robot did not wait any longer for the services
};

/// Plays the robot to the services: LASER, ODOMETRY and TRUTH as fast as they are answered. A line
/// goes out when MIRROR has told of those a few before it, and OBSTACLES and LOCALISATION of what
/// was 2 s ago; a service that says nothing is waited for only so long.
class Robot {
 public:
  Robot(const LapsConfig& config, const std::vector<std::string>& services);

  /// Waits until each service has said HEALTH; false when one has not within `most`.
  bool meet_services(std::chrono::seconds most);

  /// Stands until the mirror's angle is well known, without ODOMETRY: no cloud begins the map yet.
  /// What was until then is forgotten.
  void settle();

  /// Drives for a minute of its own time.
  Minute drive_minute();

 private:
  struct Asked {
    std::int64_t utime_us;
    std::chrono::steady_clock::time_point since;
  };

  void drive_until(std::int64_t utime_us);
  void send(const simulation::SimulatedEvent& event);
  void send_line(const LaserLine& line);
  void wait_for_services(std::int64_t utime_us);
  void take(const localisation_t& message);
  void give_up_old(std::int64_t utime_us);
  bool heard_all() const;

  template <class Condition>
  void wait_until(Condition is_met);

  bus::Bus bus_{bus::BusOptions{}};
  Laps laps_;
  RecentTruth truth_;
  std::map<std::string, Watch> watches_;
  std::vector<Asked> asked_;   ///< clouds that have no answer yet
  std::int64_t begin_us_ = 0;  ///< of the next minute
  bool is_settled_ = false;
  std::int64_t lines_ = 0, mirrors_ = 0;
  std::int64_t answered_us_ = 0, obstacles_us_ = 0;  ///< the newest times; 0: none came yet
  Minute now_;
};

}  // namespace voxlist::soak
