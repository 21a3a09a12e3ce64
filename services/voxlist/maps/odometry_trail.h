#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/uncertain_pose.h"

namespace voxlist::desk {

/// Where odometry had each scan of a drive: a scan that was not placed when it came is expected
/// between those that were.
class OdometryTrail {
 public:
  void note(std::int64_t utime_us, const std::optional<Pose2>& T_odom_base);

  /// Where the scan of that time should be, T_map_base, by the way to it from the placed scan
  /// before or from the one after, whichever is shorter. Nothing without odometry.
  std::optional<UncertainPose> expect(const std::vector<StampedPose3>& placed,
                                      std::int64_t utime_us) const;

 private:
  std::optional<UncertainPose> expect_from(const StampedPose3& placed, std::int64_t utime_us) const;

  std::map<std::int64_t, Pose2> T_odom_base_;
};

}  // namespace voxlist::desk
