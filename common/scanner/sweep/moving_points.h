#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/scanner/sweep/beam_geometry.h"

namespace voxlist {
class OdometryBuffer;
}

namespace voxlist::scanner {

/// Points that a moving robot saw one after the other, on their way into one cloud. Each is put
/// into odom as soon as odometry has passed its time, so that little is left to do at the end.
class MovingPoints {
 public:
  /// Without odometry (nullptr) the robot is taken to stand. With it, `max_extrapolation_us` is
  /// how far beyond its newest pose a point's or the cloud's may be. `odometry` must outlive this.
  MovingPoints(const OdometryBuffer* odometry, std::int64_t max_extrapolation_us)
      : odometry_(odometry), max_extrapolation_us_(max_extrapolation_us) {}

  /// Takes a ray in base as it was at its time. Precondition: times never go back.
  void add(std::int64_t utime_us, const BeamHit& hit_base);

  /// Puts into odom what the odometry of now has passed.
  void settle();

  /// All points so far in base at a time, and forgets them. Nothing when odometry does not know
  /// where one of them was seen, or where base was at that time.
  std::optional<Cloud> finish(std::int64_t utime_us);

  std::size_t size() const { return points_.size(); }

  void clear();

 private:
  struct Point {
    std::int64_t utime_us;
    BeamHit hit;
  };

  void settle_until(std::int64_t utime_us);
  std::optional<Pose3> T_base_points(std::int64_t utime_us) const;

  const OdometryBuffer* odometry_;
  std::int64_t max_extrapolation_us_;
  std::vector<Point> points_;  // the first settled_ in odom, the others in base at their time
  std::size_t settled_ = 0;
  bool lost_ = false;  // odometry could not place a point
};

}  // namespace voxlist::scanner
