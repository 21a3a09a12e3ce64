#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/planning/rays/line_drops.h"

namespace voxlist::planning {

/// A beam that came back.
struct Ray {
  Eigen::Vector3f point;   ///< where it ended
  Eigen::Vector3f origin;  ///< where it started
  std::int64_t utime_us;
  /// Points of its cloud about it: a thing so wide that later beams meet it again.
  bool is_wide;
  /// Its range is between those of both neighbours on their way: half of the beam met one thing and
  /// half the other, and nothing is there.
  bool is_mixed;
  int passed;          ///< later rays that went through where it ended
  bool came = false;   ///< it ended where rays went through before
  LineDrop drop = {};  ///< what its scan line says
};

/// The rays of the last clouds. They are kept in odom, and given in base.
class RayWindow {
 public:
  /// Brings all rays into base as it stands now, and forgets those before `oldest_us` and those
  /// that later rays went through.
  void advance(const Pose3& T_odom_base, std::int64_t oldest_us);

  /// Adds a cloud's rays, in base as of the last advance(), and returns them.
  std::vector<Ray> add(const Cloud& cloud_base);

  /// Says of the rays that were added last which met something that has come.
  void mark_came(const std::vector<bool>& came);

  /// They are in base as of the last advance(), oldest first.
  const std::vector<Ray>& rays() const { return rays_; }

  /// Forgets rays of before a time that ended on wide things within `radius_m` of one of these
  /// places, as seen from above: they are gone.
  void forget_gone(const std::vector<Eigen::Vector3f>& places, float radius_m,
                   std::int64_t before_us);

  void forget_all_but(std::vector<Ray> news) { rays_ = std::move(news); }
  void clear() { rays_.clear(); }

 private:
  std::vector<Ray> rays_;
  Pose3 T_odom_base_ = Pose3::Identity();
};

}  // namespace voxlist::planning
