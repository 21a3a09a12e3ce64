#include "voxlist/evaluation/evaluation.h"

#include <algorithm>
#include <cmath>

#include "voxlist/evaluation/association.h"
#include "voxlist/geometry/elementary.h"
#include "voxlist/system/check.h"

namespace voxlist::evaluation {
namespace {

using Eigen::Vector2d;

// A true pose and its estimate, each in its own frame.
struct Match {
  std::size_t row;
  std::int64_t utime_us;
  Pose3 truth;
  Pose3 estimate;
  Pose2 truth2;
  Pose2 estimate2;
};

using Matches = std::vector<Match>;

Vector2d position(const Pose2& pose) { return {pose.x_m, pose.y_m}; }

Matches match(const std::vector<StampedPose3>& estimate, const io::PoseTable& truth,
              const PosePairs& pairs) {
  Matches matches;
  for (const auto& [row, index] : pairs.pairs) {
    const io::PoseRow& t = truth.rows[row];
    const Pose3& e = estimate[index].pose;
    matches.push_back({row, t.utime_us, t.pose, e, to_pose2(t.pose), to_pose2(e)});
  }
  return matches;
}

Pose2 best_alignment(const Matches& matches) {
  std::vector<Vector2d> from, to;
  for (const Match& m : matches) {
    from.push_back(position(m.estimate2));
    to.push_back(position(m.truth2));
  }
  return align(from, to);
}

struct PoseErrors {
  ErrorStatistics position_m;
  ErrorStatistics heading_rad;
};

PoseErrors errors_after(const Pose2& T_truth_estimate, const Matches& matches) {
  std::vector<double> positions, headings;
  for (const Match& m : matches) {
    const Pose2 moved = T_truth_estimate * m.estimate2;
    positions.push_back(distance_m(moved, m.truth2));
    headings.push_back(turn_rad(moved, m.truth2));
  }
  return {statistics(positions), statistics(headings)};
}

ErrorStatistics errors_3d(const Pose2& T_truth_estimate, const Matches& matches) {
  const auto height_error = [](const Match& m) {
    return m.estimate.translation().z() - m.truth.translation().z();
  };
  std::vector<double> errors;
  for (const Match& m : matches) {
    errors.push_back(elementary::hypot(distance_m(T_truth_estimate * m.estimate2, m.truth2),
                                       height_error(m) - height_error(matches.front())));
  }
  return statistics(errors);
}

/// The difference between the estimated and the true motion from a to b, in the frame of the pose
/// that the true motion ends at.
Pose2 motion_error(const Match& a, const Match& b) {
  const Pose2 true_motion = a.truth2.inverse() * b.truth2;
  const Pose2 estimated_motion = a.estimate2.inverse() * b.estimate2;
  return true_motion.inverse() * estimated_motion;
}

PoseErrors step_errors(const Matches& matches, const std::vector<bool>& follows) {
  std::vector<double> positions, headings;
  for (std::size_t i = 1; i < matches.size(); ++i) {
    if (follows[i]) {
      const Pose2 error = motion_error(matches[i - 1], matches[i]);
      positions.push_back(position(error).norm());
      headings.push_back(std::abs(error.yaw_rad));
    }
  }
  return {statistics(positions), statistics(headings)};
}

PoseErrors errors_per_metre(const Matches& matches) {
  constexpr double kStretchM = 1.0;
  std::vector<double> travelled{0.0};
  for (std::size_t i = 1; i < matches.size(); ++i) {
    travelled.push_back(travelled.back() + distance_m(matches[i - 1].truth2, matches[i].truth2));
  }
  std::vector<double> positions, headings;
  std::size_t end = 0;
  for (std::size_t start = 0; start < matches.size(); ++start) {
    while (end < matches.size() && travelled[end] < travelled[start] + kStretchM) {
      ++end;
    }
    if (end == matches.size()) {
      break;
    }
    const double length = travelled[end] - travelled[start];
    const Pose2 error = motion_error(matches[start], matches[end]);
    positions.push_back(position(error).norm() / length);
    headings.push_back(std::abs(error.yaw_rad) / length);
  }
  return {statistics(positions), statistics(headings)};
}

/// Says for each match whether the match before it is also the pose before it in the truth.
std::vector<bool> follow_each_other(const Matches& matches, const io::PoseTable& truth) {
  std::vector<std::int64_t> times;
  for (const io::PoseRow& row : truth.rows) {
    times.push_back(row.utime_us);
  }
  std::sort(times.begin(), times.end());
  std::vector<bool> follows(matches.size(), false);
  for (std::size_t i = 1; i < matches.size(); ++i) {
    const auto next = std::upper_bound(times.begin(), times.end(), matches[i - 1].utime_us);
    follows[i] = next == times.end() || *next >= matches[i].utime_us;
  }
  return follows;
}

}  // namespace

ErrorStatistics statistics(std::vector<double> errors) {
  if (errors.empty()) {
    return {};
  }
  std::sort(errors.begin(), errors.end());
  double sum = 0.0, squares = 0.0;
  for (const double error : errors) {
    sum += error;
    squares += error * error;
  }
  const auto n = static_cast<double>(errors.size());
  const std::size_t half = errors.size() / 2;
  const double median =
      errors.size() % 2 == 1 ? errors[half] : (errors[half - 1] + errors[half]) / 2.0;
  return {errors.size(), std::sqrt(squares / n), sum / n, median, errors.back()};
}

Pose2 align(const std::vector<Vector2d>& from, const std::vector<Vector2d>& to) {
  VOXLIST_CHECK(!from.empty() && from.size() == to.size(), "align() takes pairs of points");
  Vector2d from_mean = Vector2d::Zero(), to_mean = Vector2d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    from_mean += from[i] / static_cast<double>(from.size());
    to_mean += to[i] / static_cast<double>(from.size());
  }
  double along = 0.0, across = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vector2d a = from[i] - from_mean, b = to[i] - to_mean;
    along += a.dot(b);
    across += a.x() * b.y() - a.y() * b.x();
  }
  const Pose2 turn{0.0, 0.0, elementary::atan2(across, along)};
  return Pose2{to_mean.x(), to_mean.y(), 0.0} * turn * Pose2{-from_mean.x(), -from_mean.y(), 0.0};
}

std::optional<TrajectoryErrors> evaluate(const std::vector<StampedPose3>& estimate,
                                         const io::PoseTable& truth) {
  const PosePairs pairs = associate(estimate, truth);
  if (pairs.pairs.empty()) {
    return std::nullopt;
  }
  const Matches matches = match(estimate, truth, pairs);
  const Match& first = matches.front();
  const Pose2 anchor = first.truth2 * first.estimate2.inverse();

  TrajectoryErrors result;
  result.association = pairs.association;
  result.matched = matches.size();
  result.in_truth = truth.rows.size();
  result.T_truth_estimate = best_alignment(matches);
  const PoseErrors anchored = errors_after(anchor, matches);
  const PoseErrors aligned = errors_after(result.T_truth_estimate, matches);
  const PoseErrors steps = step_errors(matches, follow_each_other(matches, truth));
  const PoseErrors metres = errors_per_metre(matches);
  result.anchored_m = anchored.position_m;
  result.anchored_heading_rad = anchored.heading_rad;
  result.aligned_m = aligned.position_m;
  result.aligned_heading_rad = aligned.heading_rad;
  result.step_m = steps.position_m;
  result.step_rad = steps.heading_rad;
  result.per_metre_m = metres.position_m;
  result.per_metre_rad = metres.heading_rad;
  if (truth.has_heights) {
    result.anchored_3d_m = errors_3d(anchor, matches);
  }
  for (const Match& m : matches) {
    result.poses.push_back({m.utime_us, m.truth2, anchor * m.estimate2});
  }
  result.end_position_m = distance_m(result.poses.back().anchored, result.poses.back().truth);
  return result;
}

}  // namespace voxlist::evaluation
