#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "voxlist/geometry/pose.h"

namespace voxlist {

/// T_base_sensor of a sensor that was turned about base's x axis first, then y, then z.
Pose3 mount_pose(const Eigen::Vector3d& position_m, double roll_deg, double pitch_deg,
                 double yaw_deg);

/// What the robot's own body fills: boxes along base's axes.
class BodyBoxes {
 public:
  /// Six numbers a box (m): x from, x to, y from, y to, z from, z to. Throws std::invalid_argument,
  /// which names the setting `key`, when they are not.
  BodyBoxes(const std::vector<double>& numbers_m, const std::string& key);

  /// Whether a point of base lies in one of them; their faces belong to them.
  bool hold(const Eigen::Vector3d& point) const;

 private:
  struct Box {
    Eigen::Array3d low, high;
  };
  std::vector<Box> boxes_;
};

}  // namespace voxlist
