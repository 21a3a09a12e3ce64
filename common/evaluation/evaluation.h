#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/drawing/picture.h"
#include "voxlist/geometry/cloud.h"
#include "voxlist/io/poses/pose_file.h"

namespace voxlist::evaluation {

/// Size of a set of errors, in the errors' own unit. All are 0 when there are no errors.
struct ErrorStatistics {
  std::size_t count = 0;
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;
  double max = 0.0;
};

/// The statistics of these errors, none of them negative.
ErrorStatistics statistics(std::vector<double> errors);

/// What poses of the estimate and of the truth were paired by.
enum class Association { kByTime, kByScanNumber };

/// A true pose and its estimate. The estimate is in the truth's frame: the trajectory was moved so
/// that its first pose lies on the true one.
struct MatchedPose {
  std::int64_t utime_us = 0;  ///< time of the true pose
  Pose2 truth;
  Pose2 anchored;
};

/// How far an estimated trajectory is from the truth, in the plane unless said otherwise.
struct TrajectoryErrors {
  Association association = Association::kByTime;
  std::size_t matched = 0;
  std::size_t in_truth = 0;

  /// Errors after the first matched pose was laid onto its truth: how far a map that starts there
  /// is off.
  ErrorStatistics anchored_m;
  ErrorStatistics anchored_heading_rad;
  double end_position_m = 0.0;  ///< error of the last matched pose

  /// The same with heights, the first height laid onto its truth, too. Nothing where the truth has
  /// no heights.
  std::optional<ErrorStatistics> anchored_3d_m;

  /// Errors after the rigid planar motion that makes the positions' RMSE smallest.
  ErrorStatistics aligned_m;
  ErrorStatistics aligned_heading_rad;
  Pose2 T_truth_estimate;  ///< that motion

  /// Errors of the motion between two poses that follow each other in the truth, both matched.
  ErrorStatistics step_m;
  ErrorStatistics step_rad;

  /// Errors of the motion over each stretch of at least 1 m along the truth, divided by its length.
  ErrorStatistics per_metre_m;
  ErrorStatistics per_metre_rad;

  std::vector<MatchedPose> poses;
};

/// Compares an estimate with the truth.
///
/// A true pose is matched with the nearest estimate in time if they are less than half the median
/// interval of the truth apart. Where no times agree, scan numbers are matched instead: the scan
/// number of an estimate is its time in seconds if all its times are whole seconds before 1971
/// (scans without times run 1 Hz from 0), else its position. Nothing matches, or one of both is
/// empty: no answer.
std::optional<TrajectoryErrors> evaluate(const std::vector<StampedPose3>& estimate,
                                         const io::PoseTable& truth);

/// The rigid planar motion that takes `from` closest to `to`: least squares over corresponding
/// points, Umeyama's closed form without scale. Precondition: as many points in both, at least one.
Pose2 align(const std::vector<Eigen::Vector2d>& from, const std::vector<Eigen::Vector2d>& to);

/// Draws both trajectories from above and, below them, the position error over time.
drawing::Picture draw_errors(const TrajectoryErrors& errors);

}  // namespace voxlist::evaluation
