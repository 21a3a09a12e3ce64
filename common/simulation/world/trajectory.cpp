#include "voxlist/simulation/world/trajectory.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "voxlist/system/check.h"

namespace voxlist::simulation {

Trajectory::Trajectory(double period_s, std::vector<Pose2> poses)
    : period_s_(period_s), poses_(std::move(poses)) {
  VOXLIST_CHECK(!poses_.empty(), "a trajectory has at least one pose");
  VOXLIST_CHECK(period_s > 0.0, "a trajectory's poses are some time apart");
}

Pose2 Trajectory::at(double t_s) const {
  const double last = static_cast<double>(poses_.size() - 1);
  const double index = std::clamp(t_s / period_s_, 0.0, last);
  const auto i = static_cast<std::size_t>(index);
  const double share = index - static_cast<double>(i);
  const Pose2& a = poses_[i];
  const Pose2& b = poses_[std::min(i + 1, poses_.size() - 1)];
  return {a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m),
          wrap_angle(a.yaw_rad + share * wrap_angle(b.yaw_rad - a.yaw_rad))};
}

}  // namespace voxlist::simulation
