#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/geometry/pose.h"
#include "voxlist/planning/rays/ray_window.h"

namespace voxlist::planning {

/// Where rays went through a moment ago: what stands there now has come. Cubes of 0.1 m in odom, up
/// to 4 m from the robot and 2 m high, for ten seconds.
class SeenVoid {
 public:
  SeenVoid();

  /// Whether each new ray, in base, ended where rays had gone through, and on all sides of it, and
  /// where no ray had ended before this look, nor beside it.
  std::vector<bool> came(const Pose3& T_odom_base, std::int64_t utime_us,
                         const std::vector<Ray>& news) const;

  /// Learns where the new rays went through and ended.
  void learn(const Pose3& T_odom_base, std::int64_t utime_us, const std::vector<Ray>& news);

  void clear();

 private:
  struct Cube {
    std::int32_t x = 0, y = 0, z = 0;
    std::int32_t passes = 0;        // since a ray ended there
    std::int64_t utime_us = 0;      // when a ray was there last; 0: never
    std::int64_t first_end_us = 0;  // 0: none ended there
  };

  const Cube* at(const Eigen::Vector3i& cube, std::int64_t utime_us) const;
  Cube& open(const Eigen::Vector3i& cube, std::int64_t utime_us);
  void pass(const Eigen::Vector3f& from_odom, const Eigen::Vector3f& to_odom,
            const Eigen::Vector3f& robot_odom, std::int64_t utime_us);

  std::vector<Cube> cubes_;
};

}  // namespace voxlist::planning
