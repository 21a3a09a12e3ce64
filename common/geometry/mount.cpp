#include "voxlist/geometry/mount.h"

#include <algorithm>
#include <stdexcept>

#include "voxlist/geometry/angle.h"

namespace voxlist {

Pose3 mount_pose(const Eigen::Vector3d& position_m, double roll_deg, double pitch_deg,
                 double yaw_deg) {
  using Eigen::Vector3d;
  Pose3 T = Pose3::Identity();
  T.linear() = rotation(yaw_deg * kRadPerDeg, Vector3d::UnitZ()) *
               rotation(pitch_deg * kRadPerDeg, Vector3d::UnitY()) *
               rotation(roll_deg * kRadPerDeg, Vector3d::UnitX());
  T.translation() = position_m;
  return T;
}

BodyBoxes::BodyBoxes(const std::vector<double>& numbers_m, const std::string& key) {
  if (numbers_m.size() % 6 != 0) throw std::invalid_argument(key + " must be boxes of six numbers");
  for (std::size_t i = 0; i < numbers_m.size(); i += 6) {
    const double* n = &numbers_m[i];
    const Box box{{n[0], n[2], n[4]}, {n[1], n[3], n[5]}};
    if ((box.low >= box.high).any())
      throw std::invalid_argument(key + ": each from must be below its to");
    boxes_.push_back(box);
  }
}

bool BodyBoxes::hold(const Eigen::Vector3d& point) const {
  return std::ranges::any_of(boxes_, [&point](const Box& box) {
    return (point.array() >= box.low).all() && (point.array() <= box.high).all();
  });
}

}  // namespace voxlist
