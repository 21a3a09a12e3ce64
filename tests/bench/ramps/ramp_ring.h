#pragma once

#include <cstdint>
#include <vector>

#include "tests/bench/ramps/slab_world.h"

namespace voxlist::bench {

/// A corridor in a ring, a block of 46 x 12 m: on its north side a ramp leads up by 1.2 m and
/// another one down again, so that the drive comes back to where it began by two ramps. The south
/// side is at height 0. Metres, radians.
struct RampRingConfig {
  double slope_rad = 0.0;
  std::uint64_t seed = 1;
};

class RampRing {
 public:
  explicit RampRing(const RampRingConfig& config);

  const SlabWorld& world() const { return world_; }

  /// Once round and on along the south side, from the middle of that.
  std::vector<Pose3> drive(double step_m) const;

 private:
  SlabWorld world_;
};

}  // namespace voxlist::bench
