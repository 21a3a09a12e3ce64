#pragma once

#include <string>
#include <vector>

#include "tests/bench/drives/bad_scans.h"
#include "voxlist/geometry/tilt.h"

namespace voxlist::bench {

/// Where a robot drives. On floors it drives 5 m about a room, through a door or along the
/// corridor.
enum class Place { kBareCorridor, kCorridorWithDoors, kStreet, kFloor };

/// What it scans with: 360 rays in each ring, the mirror scanner, or a laser that sees all round.
enum class Laser { k16Rings, k25Rings, k49Rings, kMirror, k64000Rays };

/// What the wheels measure: the truth; with the simulator's errors; with these, and every fifth
/// step too far, for wheels that slip; nothing.
enum class Wheels { kExact, kDrifting, kSlipping, kNone };

/// Drives that are alike.
struct DriveSpec {
  std::string name;
  Place place = Place::kFloor;
  Laser laser = Laser::kMirror;
  Wheels wheels = Wheels::kDrifting;
  double step_m = 0.5;  ///< not on floors
  int scans = 10;       ///< on floors at most 10
  bool mapped =
      false;  ///< in a finished map of the floor; otherwise in the map that the drive makes
  bool changed = false;  ///< furniture was moved since, people stand about, 5 % short returns
  Bad bad = Bad::kNot;
  int bad_scans = 0;                ///< in a row
  TiltUse tilt = TiltUse::kPlanar;  ///< what the localiser is told of it; the robot stands level
  bool carried = false;  ///< to another room of the mapped floor, and the wheels do not notice
};

/// All kinds of drives that tracking is measured on.
std::vector<DriveSpec> all_drives();

}  // namespace voxlist::bench
