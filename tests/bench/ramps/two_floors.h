#pragma once

#include <cstdint>
#include <vector>

#include "tests/bench/ramps/slab_world.h"

namespace voxlist::bench {

/// Two floors of one room each, of the same size and furnished otherwise, one above the other,
/// joined by two flights of a ramp beside them with a landing between. Metres, radians. The lower
/// floor is at height 0.
struct TwoFloorsConfig {
  double slope_rad = 0.0;
  std::uint64_t seed = 1;
};

class TwoFloors {
 public:
  explicit TwoFloors(const TwoFloorsConfig& config);

  const SlabWorld& world() const { return world_; }

  /// Height of the upper floor.
  double upper_m() const { return upper_m_; }

  /// A robot that stands at a place on the floor there, or on the ramp; `above_m`: a height from
  /// which the ground is the next thing below.
  Pose3 standing(const Pose2& place, double above_m) const;

  /// From the lower room round it, up, round the upper room, down again and back to where it began:
  /// poses no more than `step_m` and 20 deg apart.
  std::vector<Pose3> drive(double step_m) const;

 private:
  double upper_m_;
  double flight_m_;
  SlabWorld world_;
};

}  // namespace voxlist::bench
