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

// A way's chord lies in the middle of its turn.
Eigen::Vector3d velocity_of(const Pose2& way, double dt_s) {
  return planar_turn(-way.yaw_rad / 2.0) * Eigen::Vector3d(way.x_m, way.y_m, way.yaw_rad) / dt_s;
}

Pose2 way_of(const Eigen::Vector3d& velocity, double dt_s) {
  const Eigen::Vector3d way = planar_turn(velocity.z() * dt_s / 2.0) * velocity * dt_s;
  return {way.x(), way.y(), wrap_angle(way.z())};
}

constexpr int kVelocity = 3, kBias = 6;  // where the state has them

}  // namespace

TrackedPose::TrackedPose(const UncertainPose& pose) : pose_(pose.pose) {
  covariance_.topLeftCorner<3, 3>() = pose.covariance;
  covariance_(kBias, kBias) = square(kUsualScale);
  covariance_(kBias + 1, kBias + 1) = square(kUsualHeading_rad);
}

void TrackedPose::follow_odometry(const Pose2& way, double dt_s) {
  const double a = 1.0 + rest_(3), b = rest_(4);
  const UncertainPose true_way =
      by_chance({a * way.x_m - b * way.y_m, b * way.x_m + a * way.y_m, way.yaw_rad});
  const Pose2 heading{0.0, 0.0, pose_.yaw_rad};
  const Eigen::Vector3d along = heading * Eigen::Vector3d(way.x_m, way.y_m, 0.0),
                        across = heading * Eigen::Vector3d(-way.y_m, way.x_m, 0.0);
  Covariance spread = Covariance::Identity();
  spread.block<2, 1>(0, kBias) = along.head<2>();
  spread.block<2, 1>(0, kBias + 1) = across.head<2>();
  forget_velocity(true_way.covariance.diagonal().cwiseSqrt() / dt_s);
  set_velocity(true_way.pose, dt_s);
  move_to(pose() * true_way);
  covariance_ = spread * covariance_ * spread.transpose();
  covariance_.bottomRightCorner<2, 2>().diagonal().array() +=
      square(kBiasChange) * distance_m({}, way);
}

void TrackedPose::go_on(double dt_s, const Eigen::Vector3d& change) {
  const Eigen::Vector3d velocity = rest_.head<3>();
  Eigen::Matrix<double, 8, 3> each = Eigen::Matrix<double, 8, 3>::Zero();
  each.topRows<3>() = dt_s * planar_turn(pose_.yaw_rad + velocity.z() * dt_s / 2.0);
  each.middleRows<3>(kVelocity).setIdentity();
  Covariance spread = Covariance::Identity();
  spread.middleCols<3>(kVelocity) = each;
  move_to(pose() * UncertainPose{way_of(velocity, dt_s)});
  covariance_ = spread * covariance_ * spread.transpose() +
                each * change.cwiseAbs2().asDiagonal() * each.transpose();
}

void TrackedPose::forget_velocity(const Eigen::Vector3d& sigmas) {
  rest_.head<3>().setZero();
  covariance_.middleRows<3>(kVelocity).setZero();
  covariance_.middleCols<3>(kVelocity).setZero();
  covariance_.block<3, 3>(kVelocity, kVelocity) = sigmas.cwiseAbs2().asDiagonal();
}

void TrackedPose::set_velocity(const Pose2& way, double dt_s) {
  rest_.head<3>() = velocity_of(way, dt_s);
}

void TrackedPose::doubt(double times) { covariance_.topLeftCorner<kBias, kBias>() *= times; }

void TrackedPose::blur(const Eigen::Matrix3d& covariance) {
  covariance_.topLeftCorner<3, 3>() += covariance;
}

void TrackedPose::move_to(const UncertainPose& expected) {
  Eigen::Matrix<double, 3, 5> shared = covariance_.topRightCorner<3, 5>();
  shared.row(0) -= (expected.pose.y_m - pose_.y_m) * shared.row(2);
  shared.row(1) += (expected.pose.x_m - pose_.x_m) * shared.row(2);
  covariance_.topRightCorner<3, 5>() = shared;
  covariance_.bottomLeftCorner<5, 3>() = shared.transpose();
  covariance_.topLeftCorner<3, 3>() = expected.covariance;
  pose_ = expected.pose;
}

void TrackedPose::change_map(const Pose2& T_new_old) {
  Covariance turn = Covariance::Identity();
  turn.topLeftCorner<3, 3>() = planar_turn(T_new_old.yaw_rad);
  pose_ = T_new_old * pose_;
  covariance_ = turn * covariance_ * turn.transpose();
}

void TrackedPose::learn(const UncertainPose& pose) {
  const Eigen::Matrix3d before = covariance_.topLeftCorner<3, 3>();
  const Eigen::Matrix<double, 3, 5> shared = covariance_.topRightCorner<3, 5>();
  // What the rest is for each unit of the pose.
  const Eigen::Matrix<double, 3, 5> share = before.llt().solve(shared);
  rest_ += share.transpose() * difference(pose.pose, pose_);
  covariance_.bottomRightCorner<5, 5>() -= share.transpose() * (before - pose.covariance) * share;
  covariance_.topRightCorner<3, 5>() = pose.covariance * share;
  covariance_.bottomLeftCorner<5, 3>() = covariance_.topRightCorner<3, 5>().transpose();
  covariance_.topLeftCorner<3, 3>() = pose.covariance;
  pose_ = pose.pose;
}

OdometryBias TrackedPose::odometry() const {
  const Eigen::Vector2d factor(1.0 + rest_(3), rest_(4));
  return {factor.norm() - 1.0, elementary::atan2(factor(1), factor(0)),
          std::sqrt(covariance_(kBias, kBias)), std::sqrt(covariance_(kBias + 1, kBias + 1))};
}

Eigen::Vector3d TrackedPose::velocity_variances() const {
  return covariance_.diagonal().segment<3>(kVelocity);
}

}  // namespace voxlist::matching
