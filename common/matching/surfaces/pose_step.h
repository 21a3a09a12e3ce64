#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <utility>

#include "voxlist/geometry/pose.h"

// What a refinement moves: kDof = 3 is (x, y, yaw), kDof = 6 is (x, y, z, roll, pitch, yaw). Turns
// are about the map's axes, through base.

namespace voxlist::matching {

/// A step of the coordinates that are moved (m, rad), or a value for each of them.
template <int kDof>
using Step = Eigen::Matrix<double, kDof, 1>;
template <int kDof>
using Square = Eigen::Matrix<double, kDof, kDof>;

/// How many of a step's coordinates, the first ones, are shifts; the others are turns.
template <int kDof>
inline constexpr int kShifts = kDof == 3 ? 2 : 3;

/// The same value for all shifts, and another one for all turns.
template <int kDof>
Step<kDof> shifts_and_turns(double shift_m, double turn_rad) {
  Step<kDof> all = Step<kDof>::Constant(turn_rad);
  all.template head<kShifts<kDof>>().setConstant(shift_m);
  return all;
}

/// Adds column(j) to each column of the lower triangle; what is above it is left undefined. From
/// even rows on, so that two elements at a time are added.
template <int kDof, class Column>
void add_lower(const Column& column, Square<kDof>& sum) {
  const auto add = [&]<int... j>(std::integer_sequence<int, j...>) {
    ((sum.col(j).template tail<kDof - j / 2 * 2>() += column(j).template tail<kDof - j / 2 * 2>()),
     ...);
  };
  add(std::make_integer_sequence<int, kDof>());
}

/// The symmetric matrix with this lower triangle.
template <int kDof>
Square<kDof> mirrored(const Square<kDof>& lower) {
  return lower.template selfadjointView<Eigen::Lower>();
}

/// How a point's distance from a plane with normal n changes by a step; `arm` is from base to the
/// point, in map's axes.
template <int kDof>
Step<kDof> slope(const Eigen::Vector3d& n, const Eigen::Vector3d& arm) {
  const double yaw = arm.x() * n.y() - arm.y() * n.x();
  if constexpr (kDof == 3)
    return {n.x(), n.y(), yaw};
  else
    return {
        n.x(), n.y(), n.z(), arm.y() * n.z() - arm.z() * n.y(), arm.z() * n.x() - arm.x() * n.z(),
        yaw};
}

inline void move(const Step<3>& step, Pose3& pose) {
  pose.translation().head<2>() += step.head<2>();
  pose.linear() = rotation(step.z(), Eigen::Vector3d::UnitZ()) * pose.linear();
}

inline void move(const Step<6>& step, Pose3& pose) {
  const Eigen::Vector3d turn = step.tail<3>();
  const double angle = turn.norm();
  pose.translation() += step.head<3>();
  if (angle > 0.0) pose.linear() = rotation(angle, turn / angle) * pose.linear();
}

}  // namespace voxlist::matching
