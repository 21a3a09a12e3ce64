#include "voxlist/matching/motion/tracked_pose.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "voxlist/geometry/elementary.h"
#include "voxlist/matching/motion/pose_fusion.h"

namespace voxlist::matching {
namespace {

// What odometry's scale and the direction of its ways (rad) are off by, as standard deviations,
// before anything is known: the wheels' size, the laser's mount. Along a bare corridor the scale
// alone says how far a pose is known to 0.3 m: 15 m.
constexpr double kUsualScale = 0.02, kUsualHeading_rad = 0.03;
// What they change by on one metre: tyres warm up, loads shift. They follow within tens of metres.
constexpr double kBiasChange = 0.002;

// Beside these, odometry errs by chance by these standard deviations (m, rad) at least, and by
// these shares of the way and of the turn.
constexpr double kOdometry_m = 0.005, kOdometryShare = 0.01;
constexpr double kOdometry_rad = 0.01, kOdometryTurnShare = 0.05, kOdometry_rad_per_m = 0.01;

double square(double x) { return x * x; }

UncertainPose by_chance(const Pose2& way) {
  const double way_m = distance_m({}, way), shift = square(kOdometry_m + kOdometryShare * way_m),
               turn = square(kOdometry_rad + kOdometryTurnShare * std::abs(way.yaw_rad) +
                             kOdometry_rad_per_m * way_m);
  return {way, Eigen::Vector3d(shift, shift, turn).asDiagonal()};
}

}  // namespace

TrackedPose::TrackedPose(const UncertainPose& pose) : pose_(pose.pose) {
  covariance_.topLeftCorner<3, 3>() = pose.covariance;
  covariance_(3, 3) = square(kUsualScale);
  covariance_(4, 4) = square(kUsualHeading_rad);
}

void TrackedPose::follow_odometry(const Pose2& way) {
  const double a = 1.0 + bias_(0), b = bias_(1);
  const Pose2 true_way{a * way.x_m - b * way.y_m, b * way.x_m + a * way.y_m, way.yaw_rad};
  const Pose2 heading{0.0, 0.0, pose_.yaw_rad};
  const Eigen::Vector3d along = heading * Eigen::Vector3d(way.x_m, way.y_m, 0.0),
                        across = heading * Eigen::Vector3d(-way.y_m, way.x_m, 0.0);
  Eigen::Matrix<double, 5, 5> spread = Eigen::Matrix<double, 5, 5>::Identity();
  spread.block<2, 1>(0, 3) = along.head<2>();
  spread.block<2, 1>(0, 4) = across.head<2>();
  move_to(pose() * by_chance(true_way));
  covariance_ = spread * covariance_ * spread.transpose();
  covariance_.bottomRightCorner<2, 2>().diagonal().array() +=
      square(kBiasChange) * distance_m({}, way);
}

void TrackedPose::move_to(const UncertainPose& expected) {
  Eigen::Matrix<double, 3, 2> shared = covariance_.topRightCorner<3, 2>();
  shared.row(0) -= (expected.pose.y_m - pose_.y_m) * shared.row(2);
  shared.row(1) += (expected.pose.x_m - pose_.x_m) * shared.row(2);
  covariance_.topRightCorner<3, 2>() = shared;
  covariance_.bottomLeftCorner<2, 3>() = shared.transpose();
  covariance_.topLeftCorner<3, 3>() = expected.covariance;
  pose_ = expected.pose;
}

void TrackedPose::change_map(const Pose2& T_new_old) {
  const auto [sine, cosine] = elementary::sine_cosine(T_new_old.yaw_rad);
  Eigen::Matrix<double, 5, 5> turn = Eigen::Matrix<double, 5, 5>::Identity();
  turn.topLeftCorner<2, 2>() << cosine, -sine, sine, cosine;
  pose_ = T_new_old * pose_;
  covariance_ = turn * covariance_ * turn.transpose();
}

void TrackedPose::learn(const UncertainPose& pose) {
  const Eigen::Matrix3d before = covariance_.topLeftCorner<3, 3>();
  const Eigen::Matrix<double, 3, 2> shared = covariance_.topRightCorner<3, 2>();
  // What the bias is for each unit of the pose.
  const Eigen::Matrix<double, 3, 2> share = before.llt().solve(shared);
  bias_ += share.transpose() * difference(pose.pose, pose_);
  covariance_.bottomRightCorner<2, 2>() -= share.transpose() * (before - pose.covariance) * share;
  covariance_.topRightCorner<3, 2>() = pose.covariance * share;
  covariance_.bottomLeftCorner<2, 3>() = covariance_.topRightCorner<3, 2>().transpose();
  covariance_.topLeftCorner<3, 3>() = pose.covariance;
  pose_ = pose.pose;
}

OdometryBias TrackedPose::odometry() const {
  const Eigen::Vector2d factor(1.0 + bias_(0), bias_(1));
  return {factor.norm() - 1.0, elementary::atan2(factor(1), factor(0)),
          std::sqrt(covariance_(3, 3)), std::sqrt(covariance_(4, 4))};
}

}  // namespace voxlist::matching
