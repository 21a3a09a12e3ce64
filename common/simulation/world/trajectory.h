#pragma once

#include <vector>

#include "voxlist/geometry/pose.h"

namespace voxlist::simulation {

/// Poses at even steps of time, from t = 0.
class Trajectory {
 public:
  /// Poses `period_s` apart. Precondition: there is at least one, and period_s > 0.
  Trajectory(double period_s, std::vector<Pose2> poses);

  /// The pose at a time, interpolated; held before the first and after the last.
  Pose2 at(double t_s) const;

  /// Time of the last pose.
  double duration_s() const { return period_s_ * static_cast<double>(poses_.size() - 1); }

  double period_s() const { return period_s_; }
  const std::vector<Pose2>& poses() const { return poses_; }

 private:
  double period_s_;
  std::vector<Pose2> poses_;
};

}  // namespace voxlist::simulation
