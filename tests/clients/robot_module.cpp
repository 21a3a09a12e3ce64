// A module of the robot, as its author would write it: LCM and the message types are all it needs.
// Usage: robot_module [N [TIMEOUT_S]]: ends well once N poses and N times obstacles have come.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <lcm/lcm-cpp.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pose_t.hpp>

struct RobotModule {
  void on_pose(const lcm::ReceiveBuffer*, const std::string&, const voxlist::pose_t* pose) {
    ++poses;
    std::printf("pose: x %.2f m, y %.2f m\n", pose->pos[0], pose->pos[1]);
  }

  void on_obstacles(const lcm::ReceiveBuffer*, const std::string&, const voxlist::obstacles_t* o) {
    ++obstacles;
    const auto nearest = std::min_element(o->ranges_m.begin(), o->ranges_m.end());
    if (nearest == o->ranges_m.end()) return;
    const auto sector = static_cast<float>(nearest - o->ranges_m.begin());
    std::printf("nearest obstacle: %.2f m at %.2f rad\n", *nearest, o->rad0 + sector * o->radstep);
  }

  int poses = 0, obstacles = 0;
};

int main(int argc, char** argv) {
  const int wanted = argc > 1 ? std::atoi(argv[1]) : 5;
  const std::chrono::seconds timeout(argc > 2 ? std::atoi(argv[2]) : 30);
  lcm::LCM lcm;
  if (!lcm.good()) return 2;
  RobotModule module;
  lcm.subscribe("POSE", &RobotModule::on_pose, &module);
  lcm.subscribe("OBSTACLES", &RobotModule::on_obstacles, &module);

  const auto end = std::chrono::steady_clock::now() + timeout;
  const auto done = [&] { return module.poses >= wanted && module.obstacles >= wanted; };
  while (!done() && std::chrono::steady_clock::now() < end) lcm.handleTimeout(100);
  return done() ? 0 : 1;
}
