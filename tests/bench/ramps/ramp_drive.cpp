#include "tests/bench/ramps/ramp_drive.h"

#include <utility>

#include "voxlist/geometry/angle.h"
#include "voxlist/simulation/random.h"

namespace voxlist::bench {

RampDrive ramp_drive(std::vector<Pose3> truth, std::uint64_t seed) {
  simulation::Random random(seed);
  const double scale = random.uniform(0.98, 1.02), drift_radpm = random.uniform(-0.01, 0.01);
  RampDrive drive;
  drive.truth = std::move(truth);
  Pose2 T_odom_base;
  for (std::size_t i = 0; i < drive.truth.size(); ++i) {
    const Pose3& pose = drive.truth[i];
    if (i > 0) {
      const Pose3& before = drive.truth[i - 1];
      const double way_m = (before.inverse() * pose).translation().norm(),
                   turn_rad = wrap_angle(to_pose2(pose).yaw_rad - to_pose2(before).yaw_rad);
      T_odom_base = T_odom_base * Pose2{scale * way_m, 0.0, turn_rad + drift_radpm * way_m};
    }
    drive.T_odom_base.push_back(T_odom_base);
    const Tilt tilt = tilt_of(pose);
    drive.odometry_tilt.push_back({0.0, tilt.roll_rad + 0.3 * kRadPerDeg * random.normal(),
                                   tilt.pitch_rad + 0.3 * kRadPerDeg * random.normal()});
  }
  return drive;
}

}  // namespace voxlist::bench
