#pragma once

#include <string>
#include <vector>

#include "tests/bench/test_floor.h"
#include "voxlist/matching/localisation/localisation.h"

namespace voxlist::bench {

/// What is asked of a map.
struct Kind {
  std::string name;
  bool changed = false;        ///< furniture was moved since it was mapped
  bool foreign = false;        ///< the robot is in another building
  bool dense = false;          ///< by a laser that sees all round
  int people = 0;              ///< that stand round the robot
  double short_returns = 0.0;  ///< the share of returns that are shortened at random
};

/// The building that the robot is in.
simulation::Building now(const Kind& kind, const TestFloorConfig& mapped);

/// A scan of that kind as it comes from the laser, from one without short returns.
Cloud as_seen(const Kind& kind, Cloud scan, simulation::Random& random);

/// A scan, and where it was taken.
struct Query {
  Cloud scan;
  Pose2 truth;
};

/// Scans of a robot that stands here and there on the floor. Equal arguments give equal bits.
std::vector<Query> scans_about(const Kind& kind, const TestFloor& floor,
                               const simulation::Building& building, int count, int seed);

/// Index of the mode within 0.15 m and 1.5 deg of the truth; -1 where none is, and in a foreign
/// building, where no mode is right.
int right_mode(const matching::Localisation& result, const Pose2& truth, bool foreign);

/// Answers to queries of one kind, counted by what they claimed and whether it was right.
struct Tally {
  int asked = 0, tracking_right = 0, tracking_wrong = 0, ambiguous = 0, ambiguous_listed = 0,
      lost = 0, first_right = 0;
  double most_of_wrong = 0.0;  ///< the highest probability said of a wrong first mode

  void add(const matching::Localisation& result, const Pose2& truth, bool foreign);
  void print(const std::string& name) const;
};

}  // namespace voxlist::bench
