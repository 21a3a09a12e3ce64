#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "voxlist/simulation/building/box_tree.h"
#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/world/trajectory.h"

namespace voxlist::simulation {

/// How many people walk about, and how fast.
struct PeopleConfig {
  int count = 0;
  double speed_mps = 1.0;
};

/// People who walk from room to room for ever, on closed paths of their own, at one speed. Near the
/// robot they turn round, and ways on which it would run into them are not taken. One trajectory
/// for each, as long as the robot's and at least `duration_s`; fewer than asked for when the robot
/// leaves no room for them. Equal arguments give equal bits.
std::vector<Trajectory> walk(const Building& building, const Trajectory& robot, double duration_s,
                             const PeopleConfig& config, std::uint64_t seed);

/// A person: legs, trunk and head, standing at a pose, facing along its heading.
std::array<Box, 3> person_at(const Pose2& pose);

}  // namespace voxlist::simulation
