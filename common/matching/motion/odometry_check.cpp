#include "voxlist/matching/motion/odometry_check.h"

#include <algorithm>
#include <cmath>

namespace voxlist::matching {
namespace {

// Odometry may be off by these standard deviations (m, rad), and by these shares of the way and of
// the turns: with wheels whose size is known to a few per cent, and that do not slip.
constexpr double kWay_m = 0.02, kWayShare = 0.03;
constexpr double kTurn_rad = 0.01, kTurnShare = 0.03, kTurn_rad_per_m = 0.005;

// What is compared lies no farther back (us).
constexpr std::int64_t kLongest_us = 10'000'000;
// More poses are not kept: ten seconds of a fast scanner.
constexpr std::size_t kMostSamples = 200;

// Odometry disagrees from so many standard deviations on. Along a street of 280 sparse scans it
// comes to 2.4 with good wheels, to 5.4 where they slip by 0.6 m, and to 6.3 where they turn by 8
// deg.
constexpr double kDisagrees = 3.0;

Eigen::Matrix3d spread(double way_m, double turned_rad) {
  const double turn = kTurn_rad + kTurnShare * turned_rad + kTurn_rad_per_m * way_m;
  // A wrong heading takes the way aside, by half of it in the mean.
  const double position = kWay_m + kWayShare * way_m + turn * way_m / 2.0;
  return Eigen::Vector3d(position * position, position * position, turn * turn).asDiagonal();
}

}  // namespace

bool OdometryError::disagrees() const { return sigmas > kDisagrees; }

OdometryError OdometryCheck::error(const Sample& from, const Sample& to) {
  const double way_m = to.way_m - from.way_m;
  const UncertainPose way{from.T_odom_base.inverse() * to.T_odom_base,
                          spread(way_m, to.turned_rad - from.turned_rad)};
  UncertainPose expected = from.T_map_base * way;
  expected.covariance += to.T_map_base.covariance;
  const Pose2& pose = to.T_map_base.pose;
  return {way_m, static_cast<double>(to.utime_us - from.utime_us) * 1e-6,
          distance_m(pose, expected.pose), turn_rad(pose, expected.pose),
          std::sqrt(mahalanobis2(pose, expected))};
}

std::optional<OdometryError> OdometryCheck::add(std::int64_t utime_us,
                                                const UncertainPose& T_map_base,
                                                const std::optional<Pose2>& T_odom_base) {
  if (!T_odom_base) {
    clear();
    return std::nullopt;
  }
  Sample now{utime_us, T_map_base, *T_odom_base, 0.0, 0.0};
  if (!past_.empty()) {
    const Sample& last = past_.back();
    now.way_m = last.way_m + distance_m(last.T_odom_base, *T_odom_base);
    now.turned_rad = last.turned_rad + turn_rad(last.T_odom_base, *T_odom_base);
  }
  while (!past_.empty() &&
         (utime_us - past_.front().utime_us > kLongest_us || past_.size() >= kMostSamples))
    past_.pop_front();
  past_.push_back(now);
  return worst();
}

// A pose that is wrong by itself, at either end of a way, is not odometry's fault: of the ways from
// and to neighbours, that counts which is off least.
std::optional<OdometryError> OdometryCheck::worst() const {
  std::optional<OdometryError> worst;
  for (std::size_t i = 1; i + 2 < past_.size(); ++i) {
    OdometryError least = error(past_[i], past_.back());
    for (const std::size_t from : {i - 1, i})
      for (const Sample* to : {&past_[past_.size() - 2], &past_.back()})
        if (const OdometryError other = error(past_[from], *to); other.sigmas < least.sigmas)
          least = other;
    if (!worst || least.sigmas > worst->sigmas) worst = least;
  }
  return worst;
}

}  // namespace voxlist::matching
