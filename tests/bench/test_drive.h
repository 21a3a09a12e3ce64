#pragma once

#include <cstdint>
#include <vector>

#include "tests/bench/test_floor.h"

namespace voxlist::bench {

/// One scan of a drive, and where it was taken (the sweep's end).
struct DriveStep {
  Cloud scan;         ///< put together by what the wheels measured, as a robot has it
  Pose2 truth;        ///< T_map_base
  Pose2 T_odom_base;  ///< by the wheels, from the drive's start: drifts
};

/// Where a drive leads: about in one room, out of a room into the corridor or the other way round,
/// or along the corridor.
enum class DriveKind { kRoom, kDoor, kCorridor };

/// A drive of 5 m and its ten scans, the first while the robot still stands, the others evenly over
/// the time (one in 1 to 2 s), by the simulator's robot, wheels and sweeps. `now` is what stands
/// there today: the floor's own building, or later(); the way is free in it. People stand beside
/// the way. Equal arguments give equal bits.
std::vector<DriveStep> drive_through(const TestFloor& floor, const simulation::Building& now,
                                     DriveKind kind, int people, std::uint64_t seed);

}  // namespace voxlist::bench
