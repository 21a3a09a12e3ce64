#include "tests/bench/ramps/slabs.h"

#include <cmath>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/tilt.h"

namespace voxlist::bench {
namespace {

// Wheels stand this far before, behind and beside the robot's middle.
constexpr double kWheels_m = 0.25;

}  // namespace

Slab block(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  Slab slab;
  slab.T_map_slab.translation() = 0.5 * (low + high);
  slab.half_m = 0.5 * (high - low);
  return slab;
}

Slab flight(double from_x, double to_x, double y0, double y1, double from_z, double to_z) {
  constexpr double kThick_m = 0.1;
  const double slope = std::atan2(to_z - from_z, to_x - from_x), middle_x = 0.5 * (from_x + to_x);
  Slab slab;
  slab.T_map_slab.linear() = Eigen::AngleAxisd(-slope, Eigen::Vector3d::UnitY()).toRotationMatrix();
  slab.T_map_slab.translation() =
      Eigen::Vector3d(middle_x, 0.5 * (y0 + y1), 0.5 * (from_z + to_z)) -
      slab.T_map_slab.linear() * Eigen::Vector3d(0.0, 0.0, kThick_m);
  slab.half_m = {0.5 * std::hypot(to_x - from_x, to_z - from_z), 0.5 * (y1 - y0), kThick_m};
  return slab;
}

Pose3 standing(const SlabWorld& world, const Pose2& place, double above_m) {
  const auto ground = [&](double forward, double left) {
    const Eigen::Vector3d at = to_pose3(place) * Eigen::Vector3d(forward, left, 0.0);
    return world.ground_m({at.x(), at.y(), above_m});
  };
  const double front = ground(kWheels_m, 0.0), back = ground(-kWheels_m, 0.0),
               left = ground(0.0, kWheels_m), right = ground(0.0, -kWheels_m);
  return to_pose3(place, {0.5 * (front + back), std::atan2(left - right, 2.0 * kWheels_m),
                          -std::atan2(front - back, 2.0 * kWheels_m)});
}

std::vector<Pose3> drive_along(const SlabWorld& world, const std::vector<Stop>& way,
                               double step_m) {
  std::vector<Pose3> poses;
  double heading = 0.0;
  for (std::size_t i = 0; i + 1 < way.size(); ++i) {
    const Eigen::Vector2d from = way[i].at, go = way[i + 1].at - from;
    const double towards = std::atan2(go.y(), go.x()), turn = wrap_angle(towards - heading);
    const int turns = static_cast<int>(std::ceil(std::abs(turn) / (20.0 * kRadPerDeg)));
    for (int k = 0; k < turns; ++k)
      poses.push_back(standing(world, {from.x(), from.y(), wrap_angle(heading + turn * k / turns)},
                               way[i].above_m));
    heading = towards;
    const int steps = std::max(1, static_cast<int>(std::ceil(go.norm() / step_m)));
    for (int k = 0; k < steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      const Eigen::Vector2d at = from + share * go;
      const double above = way[i].above_m + share * (way[i + 1].above_m - way[i].above_m);
      poses.push_back(standing(world, {at.x(), at.y(), heading}, above));
    }
  }
  return poses;
}

}  // namespace voxlist::bench
