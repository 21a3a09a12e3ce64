#pragma once

#include <cstdint>

#include "voxlist/adapter/robot_motion.h"
#include "voxlist/adapter/sensor_points.h"
#include "voxlist/geometry/cloud.h"

namespace voxlist::adapter {

/// Adds points and where their rays started to a cloud, in the frame that T_out_odom leads to: each
/// from where the robot was when it was measured. False, and nothing is added, when odometry does
/// not know where that was.
///
/// The robot's pose is looked up every 2 ms and taken to move evenly in between: at 60 deg/s, a
/// point 30 m away is less than 0.1 mm off by that.
bool add_moved(const TimedPoints& points, const RobotMotion& motion,
               std::int64_t max_extrapolation_us, const Pose3& T_out_odom, Cloud& cloud);

/// The same of a robot that stands.
void add_standing(const TimedPoints& points, Cloud& cloud);

}  // namespace voxlist::adapter
