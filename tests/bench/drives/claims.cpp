#include "tests/bench/drives/claims.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "voxlist/matching/localisation/localiser.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::bench {
namespace {

constexpr double kNear_m = 0.1, kReach_m = 100.0;
// A claim that is better than this (m) is told by the distance alone.
constexpr double kLeastSigma_m = 0.02;

// A localiser in the map that it makes, or in a finished one.
class Robot {
 public:
  Robot(const OccupancyMap* finished, TiltUse tilt)
      : finished_(finished), localiser_(finished ? *finished : own_, one_thread(tilt)) {}

  matching::Localisation localise(const ScannedStep& step, DriveClaims& claims) {
    const bool first = !finished_ && own_.empty();
    const double start_ms = cpu_ms();
    const auto result = localiser_.localise(step.scan, step.T_odom_base);
    const double localised_ms = cpu_ms();
    if (first && result.tracking()) T_map_world_ = step.truth.inverse();
    if (!finished_ && result.tracking())
      localiser_.map_changed(
          add_scan(step.scan, to_pose3(result.modes.front().T_map_base), kReach_m, own_));
    if (first) return result;
    claims.localise_ms.push_back(localised_ms - start_ms);
    claims.map_ms.push_back(cpu_ms() - localised_ms);
    return result;
  }

  Pose2 in_map(const Pose2& T_world_base) const { return T_map_world_ * T_world_base; }

 private:
  static matching::LocaliserConfig one_thread(TiltUse tilt) {
    matching::LocaliserConfig config;
    config.tilt = tilt;
    config.threads = 1;
    return config;
  }

  const OccupancyMap* finished_;
  OccupancyMap own_;
  matching::Localiser localiser_;
  Pose2 T_map_world_;
};

void print_wrong(const DriveSpec& spec, int seed, int i, std::size_t scan,
                 const matching::Localisation& result, const Pose2& truth, const PoseError& error) {
  const matching::PoseMode& mode = result.modes.front();
  const Pose2& pose = mode.T_map_base;
  std::printf(
      "  wrong: %s, seed %d, drive %d, scan %zu: claimed %.3f %.3f %.4f, true %.3f %.3f %.4f; "
      "off %.3f m, %.1f sigma of %.3f %.3f m; probability %.4f\n",
      spec.name.c_str(), seed, i, scan, pose.x_m, pose.y_m, pose.yaw_rad, truth.x_m, truth.y_m,
      truth.yaw_rad, error.off_m, error.sigmas, std::sqrt(mode.covariance(0, 0)),
      std::sqrt(mode.covariance(1, 1)), mode.probability);
}

void count(const matching::Localisation& result, const PoseError& error, bool bad,
           DriveClaims& claims) {
  const bool tracking = result.tracking();
  claims.far += tracking && error.far();
  claims.beyond_claim += tracking && !error.far() && error.beyond_claim();
  if (bad) return;
  ++claims.scans;
  claims.tracking += tracking;
  claims.near += tracking && error.off_m < kNear_m;
  claims.ambiguous += result.state == matching::LocalisationState::kAmbiguous;
  claims.lost += result.state == matching::LocalisationState::kLost;
}

// What became of the drive after its last bad scan, or after the robot was carried away.
void count_end(const std::vector<ScannedStep>& steps, const std::vector<bool>& right,
               const std::vector<bool>& wrong, DriveClaims& claims) {
  for (std::size_t k = 1; k + 1 < steps.size(); ++k) {
    if (steps[k - 1].bad && !steps[k].bad) {
      ++claims.bad_rows;
      claims.at_next += right[k];
      claims.within_two += right[k] || right[k + 1];
    }
    if (steps[k].carried && right[k - 1]) {
      ++claims.carried;
      claims.noticed += !wrong[k + 1];
    }
  }
}

}  // namespace

PoseError error_of(const matching::PoseMode& mode, const Pose2& truth) {
  const Eigen::Vector2d off(mode.T_map_base.x_m - truth.x_m, mode.T_map_base.y_m - truth.y_m);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(mode.covariance.topLeftCorner<2, 2>());
  PoseError error{off.norm(), 0.0};
  for (int axis = 0; axis < 2; ++axis) {
    const double sigma_m = std::sqrt(std::max(0.0, axes.eigenvalues()(axis)));
    if (sigma_m >= kLeastSigma_m)
      error.sigmas =
          std::max(error.sigmas, std::abs(axes.eigenvectors().col(axis).dot(off)) / sigma_m);
  }
  return error;
}

void Reliability::add(double said, bool is_right) {
  std::size_t i = 0;
  while (said >= kUpTo[i]) ++i;
  ++bins[i].modes;
  bins[i].right += is_right;
  bins[i].said += said;
}

void Reliability::print() const {
  std::printf("probability said   scans   said on average   right\n");
  for (std::size_t i = 0; i < bins.size(); ++i) {
    if (bins[i].modes == 0) continue;
    std::printf("below %.3f        %5d             %.3f   %.3f\n", std::min(kUpTo[i], 1.0),
                bins[i].modes, bins[i].said / bins[i].modes,
                static_cast<double>(bins[i].right) / bins[i].modes);
  }
}

void DriveClaims::add(const DriveClaims& other) {
  for (const auto member : {&DriveClaims::scans, &DriveClaims::tracking, &DriveClaims::near,
                            &DriveClaims::far, &DriveClaims::beyond_claim, &DriveClaims::ambiguous,
                            &DriveClaims::lost, &DriveClaims::bad_rows, &DriveClaims::at_next,
                            &DriveClaims::within_two, &DriveClaims::carried, &DriveClaims::noticed})
    this->*member += other.*member;
  for (const auto times : {&DriveClaims::localise_ms, &DriveClaims::map_ms})
    (this->*times).insert((this->*times).end(), (other.*times).begin(), (other.*times).end());
}

DriveClaims claims_of(const DriveSpec& spec, int seed, int i, const OccupancyMap* finished,
                      Reliability& reliability, bool list) {
  const std::vector<ScannedStep> steps = scanned_drive(spec, seed, i);
  Robot robot(finished, spec.tilt);
  DriveClaims claims;
  std::vector<bool> right, wrong;
  for (const ScannedStep& step : steps) {
    const auto result = robot.localise(step, claims);
    const Pose2 truth = robot.in_map(step.truth);
    const PoseError error =
        result.modes.empty() ? PoseError{} : error_of(result.modes.front(), truth);
    count(result, error, step.bad, claims);
    const bool off = error.far() || error.beyond_claim();
    wrong.push_back(result.tracking() && off);
    right.push_back(result.tracking() && !off);
    if (wrong.back() && list) print_wrong(spec, seed, i, right.size() - 1, result, truth, error);
    if (!result.modes.empty() && right.size() > 1)
      reliability.add(result.confidence,
                      !error.far() || (error.sigmas > 0.0 && !error.beyond_claim()));
  }
  count_end(steps, right, wrong, claims);
  return claims;
}

}  // namespace voxlist::bench
