// A module of the robot, as its author would write it: LCM and the message types are all it needs.
// robot_module.py is the same in Python.
// Usage: robot_module [N [TIMEOUT_S]]: ends well once N poses and N times obstacles have come. With
// LCM_DEFAULT_URL="file://LOG?speed=0" it reads a recording.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <lcm/lcm-cpp.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pose_t.hpp>

struct RobotModule {
  void on_pose(const lcm::ReceiveBuffer*, const std::string&, const voxlist::pose_t* pose) {
    ++poses;
    std::printf("pose: x %.2f m, y %.2f m\n", pose->pos[0], pose->pos[1]);
  }

  void on_localisation(const lcm::ReceiveBuffer*, const std::string&,
                       const voxlist::localisation_t* found) {
    const char* state = found->state == voxlist::localisation_t::STATE_TRACKING    ? "tracking"
                        : found->state == voxlist::localisation_t::STATE_AMBIGUOUS ? "ambiguous"
                                                                                   : "lost";
    std::printf("localisation: %s, confidence %.3f\n", state, found->confidence);
    for (const voxlist::pose_mode_t& mode : found->modes) {
      std::printf("  x %.2f m, y %.2f m, yaw %.2f rad: %.3f\n", mode.pose[0], mode.pose[1],
                  mode.pose[2], mode.probability);
    }
  }

  void on_obstacles(const lcm::ReceiveBuffer*, const std::string&, const voxlist::obstacles_t* o) {
    ++obstacles;
    const std::vector<float>& ranges = o->nearest_m[voxlist::obstacles_t::OBSTACLE];
    const auto nearest = std::min_element(ranges.begin(), ranges.end());
    if (nearest == ranges.end()) return;
    const auto sector = static_cast<double>(nearest - ranges.begin());
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
  lcm.subscribe("LOCALISATION", &RobotModule::on_localisation, &module);
  lcm.subscribe("OBSTACLES", &RobotModule::on_obstacles, &module);

  const auto end = std::chrono::steady_clock::now() + timeout;
  const auto done = [&] { return module.poses >= wanted && module.obstacles >= wanted; };
  while (!done() && std::chrono::steady_clock::now() < end) {
    if (lcm.handleTimeout(100) < 0) break;  // a recording has ended
  }
  return done() ? 0 : 1;
}
