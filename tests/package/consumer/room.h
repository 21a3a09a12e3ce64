// A laser in a furnished room of which all is known.
#pragma once

#include <voxlist/geometry/cloud.h>
#include <voxlist/geometry/pose.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace room {

struct Box {
  Eigen::Vector3d low, high;
};

inline constexpr double kLaserHeight_m = 1.0;

// Where a ray enters and leaves a box (m along the ray).
inline std::pair<double, double> span(const Box& box, const Eigen::Vector3d& from,
                                      const Eigen::Vector3d& along) {
  const Eigen::Array3d a = (box.low - from).array() / along.array();
  const Eigen::Array3d b = (box.high - from).array() / along.array();
  return {a.min(b).maxCoeff(), a.max(b).minCoeff()};
}

inline double range_m(const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
  const Box walls{{-2.0, -3.0, 0.0}, {5.0, 2.5, 2.6}};
  const Box furniture[] = {{{2.0, 1.7, 0.0}, {3.5, 2.5, 0.8}},
                           {{-2.0, -3.0, 0.0}, {-1.4, -1.2, 2.1}},
                           {{3.9, -1.6, 0.0}, {4.3, -1.2, 2.6}},
                           {{0.8, -3.0, 0.0}, {1.7, -2.6, 1.4}}};
  double nearest = span(walls, from, along).second;
  for (const Box& box : furniture) {
    const auto [enters, leaves] = span(box, from, along);
    if (enters > 0.0 && enters < leaves) nearest = std::min(nearest, enters);
  }
  return nearest;
}

/// What the laser sees from a pose, in base.
inline voxlist::Cloud scan(const voxlist::Pose2& pose) {
  voxlist::Cloud cloud;
  const Eigen::Vector3d laser(0.0, 0.0, kLaserHeight_m), from = pose * laser;
  const voxlist::Pose2 turn{0.0, 0.0, pose.yaw_rad};
  for (int ring = -20; ring <= 20; ++ring) {
    for (int beam = 0; beam < 360; ++beam) {
      const double up = (ring + 0.3) * 0.035, yaw = (beam + 0.1 * ring) * 0.0174533;
      const Eigen::Vector3d along(std::cos(up) * std::cos(yaw), std::cos(up) * std::sin(yaw),
                                  std::sin(up));
      const double range = range_m(from, turn * along);
      cloud.points.push_back((laser + range * along).cast<float>());
      cloud.origins.push_back(laser.cast<float>());
    }
  }
  return cloud;
}

}  // namespace room
