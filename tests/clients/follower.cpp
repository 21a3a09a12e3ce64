// Drives along a way by follower.h. A robot's own program would hand each command to its wheels;
// this one writes it down.
// Usage: follower X Y [X Y...]: points of the way in map. Ends when it is there. With
// LCM_DEFAULT_URL="file://LOG?speed=0" it reads a recording.
#include "tests/clients/follower.h"

#include <cstdio>
#include <cstdlib>
#include <lcm/lcm-cpp.hpp>

struct Driver {
  explicit Driver(std::vector<Follower::Point> way) : follower(std::move(way)) {}

  // The time is the robot's own, as its messages tell it.
  void on_pose(const lcm::ReceiveBuffer*, const std::string&, const voxlist::pose_t* pose) {
    follower.take(*pose);
    drive(pose->utime);
  }

  void on_obstacles(const lcm::ReceiveBuffer*, const std::string&,
                    const voxlist::obstacles_t* obstacles) {
    follower.take(*obstacles);
  }

  void drive(std::int64_t now_us) {
    command = follower.command(last_us = now_us);
    if (command.why_not.empty())
      std::printf("drive %.2f m/s, turn %.2f rad/s\n", command.speed_mps, command.turn_radps);
    else
      std::printf("stop: %s\n", command.why_not.c_str());
  }

  Follower follower;
  Command command;
  std::int64_t last_us = 0;
};

int main(int argc, char** argv) {
  std::vector<Follower::Point> way;
  for (int i = 1; i + 1 < argc; i += 2)
    way.emplace_back(std::atof(argv[i]), std::atof(argv[i + 1]));
  lcm::LCM lcm;
  if (way.empty() || !lcm.good()) return 2;
  Driver driver(way);
  lcm.subscribe("POSE", &Driver::on_pose, &driver);
  lcm.subscribe("OBSTACLES", &Driver::on_obstacles, &driver);
  constexpr int kSilence_ms = 100;  // no POSE for so long: it is time to look
  while (driver.command.why_not != "it is there") {
    const int handled = lcm.handleTimeout(kSilence_ms);
    if (handled < 0) return 1;  // a recording has ended
    if (handled == 0) driver.drive(driver.last_us + 1000 * kSilence_ms);
  }
}
