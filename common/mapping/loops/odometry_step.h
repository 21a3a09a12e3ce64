#pragma once

#include <optional>
#include <vector>

#include "voxlist/geometry/uncertain_pose.h"

namespace voxlist::mapping {

/// T_odom_keyframe of each keyframe, where odometry told it. Empty: there was none.
using DriveOdometry = std::vector<std::optional<Pose2>>;

/// T_from_to by odometry, as sure as odometry usually is.
std::optional<UncertainPose> odometry_step(const DriveOdometry& odometry, std::size_t from,
                                           std::size_t to);

/// Whether a step is one that odometry may tell so, within what it is off by.
bool agrees(const Pose2& T_from_to, const UncertainPose& told);

/// What two say of one motion that err independently.
UncertainPose together(const UncertainPose& a, const UncertainPose& b);

/// What a match tells together with odometry; what it tells by itself where odometry says another
/// thing, for then wheels slipped.
UncertainPose with_odometry(const UncertainPose& matched, const std::optional<UncertainPose>& told);

}  // namespace voxlist::mapping
