#pragma once

#include <cstdint>
#include <optional>
#include <vector>
#include <voxlist/obstacles_t.hpp>

#include "tests/bench/follow/followed_drive.h"
#include "voxlist/geometry/cloud.h"
#include "voxlist/planning/obstacles/obstacle_finder.h"
#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/world/world.h"

namespace voxlist::bench {

/// A simulated laser and the obstacle detector's finder on a robot that goes where it likes.
class RobotsEyes {
 public:
  RobotsEyes(FollowersLaser laser, std::uint64_t seed);

  /// The robot is there now; times go up by even steps.
  void move(double t_s, const Pose2& pose);

  /// What it sees among people, when it is time for the next look.
  std::optional<obstacles_t> look(const simulation::Building& building,
                                  const std::vector<Pose2>& people);

 private:
  Cloud slice(const simulation::World& world) const;
  Cloud rings(const simulation::World& world) const;
  double period_s() const;

  const FollowersLaser laser_;
  const std::uint64_t seed_;
  planning::ObstacleFinder finder_;
  std::vector<Pose2> poses_;  // from the first on
  double step_s_ = 0.0, t_s_ = 0.0, looked_s_ = 0.0;
};

}  // namespace voxlist::bench
