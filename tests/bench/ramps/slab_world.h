#pragma once

#include <optional>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"

namespace voxlist::bench {

/// A solid block that leans as it likes: a ramp.
struct Slab {
  Pose3 T_map_slab = Pose3::Identity();
  Eigen::Vector3d half_m = Eigen::Vector3d::Zero();  ///< half its edges
};

/// A laser that sees all round, at once: rings, or rays spread evenly over the sphere.
struct RoundLaser {
  int rays;
  int rings;  ///< 0: none
  double rings_to_deg = 15.0;
  double height_m = 0.8;
  double range_max_m = 30.0;
  double range_sd_m = 0.01;
};

class SlabWorld {
 public:
  explicit SlabWorld(std::vector<Slab> slabs);

  /// Distance along a unit vector to the first slab; none when the ray leaves the world.
  std::optional<double> range_m(const Eigen::Vector3d& origin,
                                const Eigen::Vector3d& direction) const;

  /// Height of the highest surface below a point; the point's own where there is none.
  double ground_m(const Eigen::Vector3d& above) const;

  /// What a laser sees from a pose, in base.
  Cloud scan(const Pose3& T_map_base, const RoundLaser& laser, std::uint64_t seed) const;

 private:
  struct Turned {
    Eigen::Matrix3d R_slab_map;
    Eigen::Vector3d t_slab_map, half_m;
  };
  std::vector<Turned> slabs_;
};

}  // namespace voxlist::bench
