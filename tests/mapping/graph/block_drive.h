#pragma once

#include <cmath>
#include <vector>

#include "voxlist/mapping/graph/loop_choice.h"
#include "voxlist/mapping/graph/pose_tree.h"
#include "voxlist/simulation/random.h"

// A drive through streets round blocks, with what its own motion and its loops say of it.

namespace voxlist::mapping {

/// The square of a standard deviation in x and y (m), and in yaw (rad).
inline Eigen::Matrix3d variance(double shift_m, double turn_rad) {
  return Eigen::Vector3d(shift_m * shift_m, shift_m * shift_m, turn_rad * turn_rad).asDiagonal();
}

inline Pose2 noise(simulation::Random& random, double shift_m, double turn_rad) {
  return {shift_m * random.normal(), shift_m * random.normal(), turn_rad * random.normal()};
}

struct BlockDrive {
  static constexpr double kStep_m = 0.01, kStep_rad = 0.002;
  static constexpr double kLoop_m = 0.02, kLoop_rad = 0.002;

  std::vector<Pose2> truth;
  std::vector<PoseEdge> steps;
  std::vector<Loop> loops;

  /// `keyframes` of them, 1 m apart, along streets 20 m apart; at each corner it turns or not.
  BlockDrive(std::size_t keyframes, std::uint64_t seed) : random_(seed) {
    drive(keyframes);
    for (std::size_t i = 1; i < keyframes; ++i) {
      const Pose2 seen = truth[i - 1].inverse() * truth[i] * noise(random_, kStep_m, kStep_rad);
      steps.push_back({i - 1, i, {seen, variance(kStep_m, kStep_rad)}});
    }
    find_loops();
  }

  /// Three looks from keyframes one after the other, which all say that the drive was there before,
  /// off by the same: another street that looks alike.
  void forge(std::size_t from, std::size_t to, const Pose2& off) {
    for (std::size_t i = 0; i < 3; ++i)
      add_loop(from + i, to + i, (off * truth[from + i]).inverse() * truth[to + i]);
  }

 private:
  void drive(std::size_t keyframes) {
    Pose2 pose;
    while (truth.size() < keyframes) {
      truth.push_back(pose);
      if (truth.size() % 20 == 0) pose.yaw_rad = turned(pose);
      pose = pose * Pose2{1.0, 0.0, 0.0};
    }
  }

  // Never back, and never out of the town of 80 x 80 m.
  double turned(const Pose2& pose) {
    for (;;) {
      const double yaw_rad =
          wrap_angle(pose.yaw_rad + M_PI / 2 * std::floor(random_.uniform(-1, 2)));
      const Pose2 next = Pose2{pose.x_m, pose.y_m, yaw_rad} * Pose2{20.0, 0.0, 0.0};
      if (std::abs(next.x_m) < 45.0 && std::abs(next.y_m) < 45.0) return yaw_rad;
    }
  }

  // At each second keyframe, the one that was nearest long before.
  void find_loops() {
    for (std::size_t to = 0; to < truth.size(); to += 2) {
      std::size_t nearest = to;
      for (std::size_t from = 0; from + 30 < to; ++from)
        if (nearest == to ||
            distance_m(truth[from], truth[to]) < distance_m(truth[nearest], truth[to]))
          nearest = from;
      if (nearest != to && distance_m(truth[nearest], truth[to]) < 3.0)
        add_loop(nearest, to, truth[nearest].inverse() * truth[to]);
    }
  }

  void add_loop(std::size_t from, std::size_t to, const Pose2& T_from_to) {
    const Pose2 seen = T_from_to * noise(random_, kLoop_m, kLoop_rad);
    loops.push_back({{from, to, {seen, variance(kLoop_m, kLoop_rad)}}, loops.size()});
  }

  simulation::Random random_;
};

/// Root mean square distance of poses from the true ones (m), where the first is right.
inline double rmse_m(const std::vector<Pose2>& poses, const std::vector<Pose2>& truth) {
  double squares = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    squares += std::pow(distance_m(poses[i], truth[i]), 2.0);
  return std::sqrt(squares / static_cast<double>(poses.size()));
}

}  // namespace voxlist::mapping
