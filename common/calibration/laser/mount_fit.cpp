#include "voxlist/calibration/laser/mount_fit.h"

#include <ceres/crs_matrix.h>
#include <ceres/loss_function.h>
#include <ceres/numeric_diff_cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/seconds_between.h"

namespace voxlist::calibration {
namespace {

// Behind the mount's parameters, what all of odometry is off by.
enum WheelParameter { kScale = kMountParameters, kTurnScale, kPull_radpm, kAllParameters };
using All = std::array<double, kAllParameters>;

// How far each may be from zero at all (one standard deviation): it keeps what a drive does not
// tell where it was.
constexpr All kPlausible{1.0, 1.0, std::numbers::pi, 0.1, 0.05, 0.05, 2.0 * kRadPerDeg};

// Ways are compared over this time (s), long enough that scans tell their direction; turns over a
// short one, before wheels drift. Each begins half of it after the last.
constexpr double kWay_s = 2.0, kTurn_s = 0.5;

// A motion that takes longer by this factor has a gap.
constexpr double kGap = 1.5;

constexpr std::size_t kFewestMotions = 10;

// What a scan's pose is off by, and what wheels are off by after 1 m: a map of scans that are not
// quite de-skewed, wheels of a robot indoors.
constexpr double kScan_m = 0.004, kScan_rad = 0.06 * kRadPerDeg;
constexpr double kWheels_m = 0.005, kWheels_rad = 0.5 * kRadPerDeg;

// Half of each motion is in the next one, too, and errors of a map last longer than a motion.
constexpr double kShared = 2.0;

// Residuals above this many standard deviations count less and less.
constexpr double kCauchyScale = 2.0;

// Times are seconds since the drive's first scan: utimes are too great for small steps.
struct Motion {
  double begin_s = 0.0, end_s = 0.0;
  Pose2 by_scans;
  double way_m = 0.0;
};

// Odometry between its measurements.
class Odometry {
 public:
  explicit Odometry(const LaserDrive& drive) {
    if (drive.scans.empty()) return;
    for (const StampedPose2& pose : drive.odometry)
      poses_.emplace_back(seconds_between(drive.scans.front().utime_us, pose.utime_us), pose.pose);
  }

  bool covers(double begin_s, double end_s) const {
    constexpr double kLatest_s = 0.5;  // that the clouds may be early or late
    return poses_.size() > 1 && poses_.front().first + kLatest_s < begin_s &&
           end_s + kLatest_s < poses_.back().first;
  }

  Pose2 at(double time_s) const {
    const auto later = std::ranges::upper_bound(poses_.begin() + 1, poses_.end() - 1, time_s, {},
                                                &std::pair<double, Pose2>::first);
    const auto& [a_s, a] = *std::prev(later);
    const auto& [b_s, b] = *later;
    return a * part_of(a.inverse() * b, (time_s - a_s) / (b_s - a_s));
  }

 private:
  std::vector<std::pair<double, Pose2>> poses_;
};

double way_m(const std::vector<StampedPose2>& scans, std::size_t from, std::size_t to) {
  double way = 0.0;
  for (std::size_t i = from; i < to; ++i) way += distance_m(scans[i].pose, scans[i + 1].pose);
  return way;
}

std::vector<Motion> motions_of(const std::vector<StampedPose2>& scans, const Odometry& odometry,
                               double length_s) {
  const auto time_s = [&](std::size_t i) {
    return seconds_between(scans.front().utime_us, scans[i].utime_us);
  };
  std::vector<Motion> motions;
  double next_s = 0.0;
  for (std::size_t from = 0, to = 0; from < scans.size(); ++from) {
    const double begin_s = time_s(from);
    if (begin_s < next_s) continue;
    while (to < scans.size() && time_s(to) < begin_s + length_s) ++to;
    if (to == scans.size()) break;
    const double end_s = time_s(to);
    if (end_s - begin_s > kGap * length_s || !odometry.covers(begin_s, end_s)) continue;
    motions.push_back(
        {begin_s, end_s, scans[from].pose.inverse() * scans[to].pose, way_m(scans, from, to)});
    next_s = begin_s + 0.5 * length_s;
  }
  return motions;
}

// A motion that turned by so much more on the way.
Pose2 turned(const Pose2& motion, double more_rad) {
  const Pose2 half{0.0, 0.0, 0.5 * more_rad};
  return half * motion * half;
}

// Scans' and wheels' idea of the same motion.
struct Compared {
  Motion motion;
  const Odometry* odometry;

  Pose2 by_wheels(const double* p) const {
    const Pose2 begin = odometry->at(motion.begin_s - p[kMountLatency]),
                end = odometry->at(motion.end_s - p[kMountLatency]);
    Pose2 wheels = begin.inverse() * end;
    wheels.x_m *= 1.0 + p[kScale];
    wheels.y_m *= 1.0 + p[kScale];
    return turned(wheels, p[kTurnScale] * wheels.yaw_rad + p[kPull_radpm] * motion.way_m);
  }

  double more_by_scans_rad(const Pose2& by_wheels) const {
    return wrap_angle(motion.by_scans.yaw_rad - by_wheels.yaw_rad);
  }

  double sd_of_wheels_rad() const { return kWheels_rad * std::sqrt(motion.way_m); }
};

// What turns disagree by, in standard deviations.
struct TurnDisagreement : Compared {
  bool operator()(const double* p, double* residual) const {
    residual[0] = more_by_scans_rad(by_wheels(p)) /
                  std::hypot(std::numbers::sqrt2 * kScan_rad, sd_of_wheels_rad());
    return true;
  }
};

// What ways disagree by. Wheels that turned too much on the way took half of that to its side: so
// they are asked for the way with the turn that scans tell.
struct WayDisagreement : Compared {
  bool operator()(const double* p, double* residual) const {
    const Pose2 T_base_assumed{p[kMountX], p[kMountY], p[kMountYaw]};
    const Pose2 wheels = by_wheels(p), way = turned(wheels, more_by_scans_rad(wheels));
    const Pose2 off = (way * T_base_assumed).inverse() * (T_base_assumed * motion.by_scans);
    residual[0] = off.x_m / sd_m();
    residual[1] = off.y_m / sd_m();
    return true;
  }

  // What is left of the wheels' turns is where on the way they were made.
  double sd_m() const {
    const double aside_m = motion.way_m * sd_of_wheels_rad() / std::sqrt(12.0);
    return std::sqrt(2.0 * kScan_m * kScan_m + kWheels_m * kWheels_m * motion.way_m +
                     aside_m * aside_m);
  }
};

struct Plausibility {
  bool operator()(const double* p, double* residual) const {
    for (std::size_t i = 0; i < kAllParameters; ++i) residual[i] = p[i] / kPlausible[i];
    return true;
  }
};

class Problem {
 public:
  Problem(const std::vector<Motion>& ways, const std::vector<Motion>& turns,
          const Odometry& odometry) {
    for (const Motion& way : ways) add<2>(new WayDisagreement{{way, &odometry}});
    for (const Motion& turn : turns) add<1>(new TurnDisagreement{{turn, &odometry}});
    problem_.AddResidualBlock(
        new ceres::NumericDiffCostFunction<Plausibility, ceres::CENTRAL, kAllParameters,
                                           kAllParameters>(new Plausibility),
        nullptr, parameters_.data());
  }

  // Fits all parameters, beginning at this yaw, and returns what cost is left.
  double solve(double yaw_rad) {
    parameters_ = {};
    parameters_[kMountYaw] = yaw_rad;
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 50;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    return summary.final_cost;
  }

  const All& parameters() const { return parameters_; }

  struct Quality {
    double rms = 0.0;  // of what motions disagree by
    // The parameters' standard deviations, if rms were 1.
    Eigen::Matrix<double, kAllParameters, 1> sd;
  };
  Quality quality() {
    std::vector<double> residuals;
    ceres::CRSMatrix jacobian;
    problem_.Evaluate({}, nullptr, &residuals, nullptr, &jacobian);
    Eigen::Matrix<double, kAllParameters, kAllParameters> information =
        Eigen::Matrix<double, kAllParameters, kAllParameters>::Zero();
    double sum = 0.0;
    for (std::size_t row = 0; row < residuals.size(); ++row) {
      const Eigen::Map<const Eigen::Matrix<double, kAllParameters, 1>> slope(
          jacobian.values.data() + jacobian.rows[row]);
      information += slope * slope.transpose();
      if (row + kAllParameters < residuals.size()) sum += residuals[row] * residuals[row];
    }
    const auto compared = static_cast<double>(residuals.size() - kAllParameters);
    return {std::sqrt(sum / compared), information.inverse().diagonal().cwiseSqrt()};
  }

 private:
  template <int kResiduals, class Disagreement>
  void add(Disagreement* disagreement) {
    problem_.AddResidualBlock(
        new ceres::NumericDiffCostFunction<Disagreement, ceres::CENTRAL, kResiduals,
                                           kAllParameters>(disagreement),
        new ceres::CauchyLoss(kCauchyScale), parameters_.data());
  }

  All parameters_{};
  ceres::Problem problem_;
};

}  // namespace

std::optional<MountFit> fit_mount(const LaserDrive& drive) {
  const Odometry odometry(drive);
  const std::vector<Motion> ways = motions_of(drive.scans, odometry, kWay_s),
                            turns = motions_of(drive.scans, odometry, kTurn_s);
  if (ways.size() < kFewestMotions) return std::nullopt;
  Problem problem(ways, turns, odometry);
  // The fit begins at eight yaws all round, since a laser may look backwards.
  double best_yaw_rad = 0.0, least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 8; ++i) {
    const double cost = problem.solve(i * std::numbers::pi / 4.0);
    if (cost >= least) continue;
    least = cost;
    best_yaw_rad = problem.parameters()[kMountYaw];
  }
  problem.solve(best_yaw_rad);
  const Problem::Quality quality = problem.quality();
  MountFit fit;
  for (int i = 0; i < kMountParameters; ++i)
    fit.correction[i] = problem.parameters()[static_cast<std::size_t>(i)];
  fit.correction[kMountYaw] = wrap_angle(fit.correction[kMountYaw]);
  fit.motions = ways.size();
  fit.disagreement = quality.rms;
  fit.sd = std::sqrt(kShared) * std::max(1.0, quality.rms) * quality.sd.head<kMountParameters>();
  return fit;
}

}  // namespace voxlist::calibration
