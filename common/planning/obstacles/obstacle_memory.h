#pragma once

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "voxlist/planning/obstacles/typed_points.h"

namespace voxlist::planning {

/// What was seen round the robot and is not in sight now, as in the ring that the robot hides from
/// its own scanner: floor that it drives over, obstacles and drops that it stands before. It is
/// kept in odom, cell by cell, until rays see something else there.
class ObstacleMemory {
 public:
  /// Forgets what was last seen before `oldest_us`.
  void forget_before(std::int64_t oldest_us);

  /// Counts new rays, in base, that went through where something stood, at any height between those
  /// at which it was met: who went away left at all of them, and near the robot few rays go low.
  /// Returns the places, in base, of what is gone now.
  std::vector<Eigen::Vector3f> look_again(const Pose3& T_odom_base, const std::vector<Ray>& news);

  /// Height of remembered floor in each cell, in base; NaN: none.
  std::vector<float> floor_heights(const Pose3& T_odom_base, const LocalGrid& grid) const;

  /// Adds what stood or gaped, in base. A drop is forgotten where there is one floor now, no part
  /// of which is lower than the rule allows.
  void recall(const Pose3& T_odom_base, const LocalGrid& grid, const LocalFloor& ground,
              const FloorRule& rule, std::vector<TypedPoint>& points);

  /// Learns what is seen now: the lowest points of the floor's cells, and what stands or gapes.
  void learn(const Pose3& T_odom_base, std::int64_t utime_us, const LocalGrid& grid,
             const std::vector<Ray>& rays, const LocalFloor& ground,
             const std::vector<TypedPoint>& points);

  /// The robot has tilted: the floor is not where it was, nor what was learned since a time.
  void forget_tilted(std::int64_t since_us);

  void clear() { entries_.clear(); }

 private:
  static constexpr int kFloor = -1;

  using Key = std::tuple<int, int, int>;  // column and row in odom, type or kFloor

  struct Entry {
    Eigen::Vector3f point;  // odom
    std::int64_t utime_us;
    float low_m, high_m;  // heights at which it was met, odom
    int passed = 0;
  };

  void note(const Eigen::Vector3f& point_odom, int type, float cell_m, std::int64_t utime_us);

  std::map<Key, Entry> entries_;
};

}  // namespace voxlist::planning
