#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "voxlist/geometry/pose.h"
#include "voxlist/planning/obstacles/local_grid.h"
#include "voxlist/planning/obstacles/obstacle_scan.h"
#include "voxlist/planning/obstacles/typed_points.h"

namespace voxlist::planning {

/// Follows things no larger than a person from sweep to sweep, and tells which of them move, and
/// which have come to where nothing was: they may go on at any time. One moves
/// that was seen three times, is farther from where it was than it is wide, and has left that
/// place empty: so the piece of a wall that comes into sight beside the last one does not.
class MovingTracks {
 public:
  /// Takes what stands round the robot now, in base: all points, and how old those may be that
  /// belong to one sighting (us; 0: one cloud sees everything).
  void update(const Pose3& T_odom_base, std::int64_t utime_us, const LocalGrid& grid,
              const std::vector<TypedPoint>& standing, std::int64_t sighting_us);

  /// What moves, where it is now by its velocity, in base.
  std::vector<MovingObstacle> moving(const Pose3& T_odom_base, std::int64_t utime_us) const;

  void clear() { tracks_.clear(); }

 private:
  struct Sighting {
    std::int64_t first_us, last_us, utime_us;  // utime_us: the mean of its points
    Eigen::Vector2d position;                  // odom
    double radius_m;
    std::ptrdiff_t points;
    bool came;
  };

  struct Track {
    std::vector<Sighting> sightings;  // oldest first
    bool moves = false, came = false;

    const Sighting& last() const { return sightings.back(); }
    Eigen::Vector2d velocity_mps() const;
  };

  static std::vector<Sighting> sightings(const Pose3& T_odom_base, std::int64_t newest_us,
                                         const LocalGrid& grid,
                                         const std::vector<const TypedPoint*>& points);
  void follow(const Sighting& sighting);
  void forget(std::int64_t utime_us);

  std::vector<Track> tracks_;
};

}  // namespace voxlist::planning
