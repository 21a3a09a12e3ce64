#include "voxlist/mapping/loops/neighbours.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "voxlist/mapping/graph/pose_tree.h"
#include "voxlist/matching/motion/pose_fusion.h"

namespace voxlist::mapping {
namespace {

// Keyframes that are farther apart than this (m) are not matched to join two parts of a drive.
constexpr double kSight_m = 20.0;
// Most matches that are tried for that, each some 20 ms.
constexpr std::size_t kMostTries = 200;
// A scan that fits one neighbour too little is matched with so many in a row. The stations that
// such a match is needed for are 11 and 17 m apart.
constexpr std::size_t kMore = 4;
// So many pairs in a row are matched by one thread: each scan but the first is made ready once.
constexpr std::size_t kPairsAtOnce = 8;
// What matches of neighbours have in common and do not tell, since both scans are bent or tilted
// alike: it grows with the root of the way (m, rad at 1 m). Real stations 7 m apart differ from
// their reference by 0.01 m and 0.001 rad in the median, and dense drives by 1 mm and 0.01 deg a
// scan.
constexpr double kDrift_m = 0.004, kDrift_rad = 0.0004;
// Odometry that leaves the turn of a step less sure than this (rad) is asked last. It knows where
// the step began and ended, not the way between: a robot that turned by much may have driven far
// through ground that was mapped before, without a keyframe, and what its yaw was off by moves the
// end by more than the step's own length tells.
constexpr double kTold_rad = 0.05;
// Where nothing but the map tells how two keyframes stand (m, rad): a share of their distance, too.
// No match confirms such a step where the map has it, so it stands there by mistake or by little
// that it shares: of real stations, one of 22 m was off by 2 m.
constexpr double kUnmatched_m = 0.1, kUnmatchedShare = 0.05, kUnmatched_rad = 0.02;

Eigen::Matrix3d variances(double shift_m, double turn_rad) {
  return Eigen::Vector3d(shift_m * shift_m, shift_m * shift_m, turn_rad * turn_rad).asDiagonal();
}

// The mean of two looks at the same motion, as far as they agree. Both are of the same two scans,
// so together they are no surer than one of them.
UncertainPose mean_of(const UncertainPose& a, const UncertainPose& b) {
  UncertainPose both = together(a, b);
  const Eigen::Vector3d off = matching::difference(b.pose, a.pose);
  both.covariance = 2.0 * both.covariance + 0.25 * off * off.transpose();
  return both;
}

std::optional<NeighbourLook> taken_before(std::size_t from, std::size_t to,
                                          const NeighbourLook& expected, const KnownLook& known,
                                          const LookMemory* memory) {
  const NeighbourLook* look = known ? known(from, to) : nullptr;
  if (look && are_alike(*look, expected)) return *look;
  return memory ? memory->neighbours(from, to, expected) : std::nullopt;
}

// Keyframe i with the one before it; several threads at once, the same for any number of them.
std::vector<NeighbourLook> look_at_neighbours(const std::vector<Pose2>& poses,
                                              const ReadCloud& read,
                                              const matching::MatcherConfig& config,
                                              const KnownLook& known, LookMemory* memory) {
  std::vector<NeighbourLook> looks(poses.size());
  const std::size_t parts = (poses.size() + kPairsAtOnce - 1) / kPairsAtOnce;
  tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t part) {
    NeighbourLooker looker(read, config);
    const std::size_t end = std::min((part + 1) * kPairsAtOnce, poses.size());
    for (std::size_t i = std::max<std::size_t>(part * kPairsAtOnce, 1); i < end; ++i) {
      const NeighbourLook expected = no_look_yet(poses[i - 1], poses[i]);
      const auto before = taken_before(i - 1, i, expected, known, memory);
      looks[i] = before ? *before : looker.look(i - 1, i, poses[i - 1], poses[i]);
      if (memory && !before) memory->keep(i - 1, i, looks[i]);
    }
  });
  return looks;
}

class Neighbours {
 public:
  Neighbours(const std::vector<Pose2>& poses, const DriveOdometry& odometry, const ReadCloud& read,
             const matching::MatcherConfig& config, const KnownLook& known, LookMemory* memory,
             const DriveHeights& heights_m)
      : poses_(poses),
        odometry_(odometry),
        heights_m_(heights_m),
        read_(read),
        config_(config),
        looks_(look_at_neighbours(poses, read, config, known, memory)),
        looker_(read, config),
        part_(poses.size()) {
    std::iota(part_.begin(), part_.end(), std::size_t{0});
  }

  std::vector<PoseEdge> join() {
    for (std::size_t i = 1; i < poses_.size(); ++i)
      add(i - 1, i, looks_[i]) || join_with_more(i - 1, i) || join_by_both(i - 1, i, kTold_rad);
    join_parts();
    for (std::size_t i = 1; i < poses_.size(); ++i)
      if (part_[i - 1] != part_[i])
        join_by_both(i - 1, i, std::numbers::pi) || add(unmatched(i - 1, i));
    return std::move(edges_);
  }

 private:
  struct Pair {
    double distance_m;
    std::size_t a, b;
  };

  Pose2 expected(std::size_t from, std::size_t to) const {
    return poses_[from].inverse() * poses_[to];
  }

  bool join(std::size_t from, std::size_t to) {
    return add(from, to, looker_.look(from, to, poses_[from], poses_[to]));
  }

  bool join_with_more(std::size_t from, std::size_t to) {
    NeighbourLook look = no_look_yet(poses_[from], poses_[to]);
    look.there = matched_with_more(from, to);
    look.back = matched_with_more(to, from);
    return add(from, to, look);
  }

  // A scan in the map of several on the other side of a step, as they are mapped.
  std::optional<UncertainPose> matched_with_more(std::size_t from, std::size_t to) {
    LocalMap map(config_);
    for (std::size_t i = 0; i < kMore; ++i) {
      const std::size_t next = from < to ? from - i : from + i;
      if (next >= poses_.size()) break;
      map.add(read_(next), expected(from, next));
    }
    return looker_.match(to, map, expected(from, to));
  }

  // Joins two keyframes by what odometry tells, and where there is a vague match by both: along a
  // corridor the match knows yaw and the way across far better.
  bool join_by_both(std::size_t from, std::size_t to, double vaguest_rad) {
    const auto told = told_step(from, to);
    if (!told || std::sqrt(told->covariance(2, 2)) > vaguest_rad) return false;
    const auto matched = edge_of(from, to, looks_[to]);
    return add({from, to, matched ? with_odometry(matched->T_from_to, told) : *told});
  }

  // What odometry tells of a step. Where it does not contradict the map, it stands as mapped: the
  // tracker had learned what the wheels are off by.
  std::optional<UncertainPose> told_step(std::size_t from, std::size_t to) const {
    auto told = odometry_step(odometry_, from, to);
    if (told && agrees(expected(from, to), *told)) told->pose = expected(from, to);
    return told;
  }

  bool add(std::size_t from, std::size_t to, const NeighbourLook& look) {
    auto edge = edge_of(from, to, look);
    if (!edge || edge->is_vague) return false;
    edge->T_from_to = with_odometry(edge->T_from_to, told_step(from, to));
    return add({from, to, edge->T_from_to});
  }

  struct MatchedStep {
    UncertainPose T_from_to;
    bool is_vague = false;
  };

  // What two matches tell of a step; of a vague one and another, the other.
  std::optional<MatchedStep> edge_of(std::size_t from, std::size_t to,
                                     const NeighbourLook& look) const {
    auto there = look.there, back = look.back;
    if (there && back && is_vague(*there) != is_vague(*back))
      (is_vague(*there) ? there : back).reset();
    if (!there && !back) return std::nullopt;
    if (back) back = reversed({to, from, *back}).T_from_to;
    MatchedStep step{there && back ? mean_of(*there, *back) : there ? *there : *back};
    step.is_vague = is_vague(there ? *there : *back);
    const double away_m = distance_m(step.T_from_to.pose, {});
    step.T_from_to.covariance += (1.0 + away_m) * variances(kDrift_m, kDrift_rad);
    return step;
  }

  // As mapped, and where there is a vague match, as that has it, too.
  PoseEdge unmatched(std::size_t from, std::size_t to) const {
    UncertainPose motion = as_mapped(expected(from, to));
    motion.covariance = variances(
        kUnmatched_m + kUnmatchedShare * distance_m(poses_[from], poses_[to]), kUnmatched_rad);
    const auto matched = edge_of(from, to, looks_[to]);
    return {from, to, matched ? together(motion, matched->T_from_to) : motion};
  }

  // Tries pairs of different parts, the nearest first.
  void join_parts() {
    std::size_t tries = 0;
    for (const Pair& pair : pairs_of_parts())
      if (part_[pair.a] != part_[pair.b] && ++tries <= kMostTries) join(pair.a, pair.b);
  }

  std::vector<Pair> pairs_of_parts() const {
    std::vector<Pair> pairs;
    for (std::size_t b = 1; b < poses_.size(); ++b)
      for (std::size_t a = 0; a < b; ++a)
        if (const double away_m = distance_m(poses_[a], poses_[b]);
            part_[a] != part_[b] && away_m <= kSight_m && may_share_floor(heights_m_, a, b))
          pairs.push_back({away_m, a, b});
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.distance_m < b.distance_m; });
    return pairs;
  }

  bool add(const PoseEdge& edge) {
    edges_.push_back(edge);
    const std::size_t gone = part_[edge.to], stays = part_[edge.from];
    std::replace(part_.begin(), part_.end(), gone, stays);
    return true;
  }

  const std::vector<Pose2>& poses_;
  const DriveOdometry& odometry_;
  const DriveHeights& heights_m_;
  const ReadCloud& read_;
  const matching::MatcherConfig& config_;
  const std::vector<NeighbourLook> looks_;
  NeighbourLooker looker_;
  // Which part of the drive each keyframe is in, by the number of one of them.
  std::vector<std::size_t> part_;
  std::vector<PoseEdge> edges_;
};

}  // namespace

std::vector<PoseEdge> join_neighbours(const std::vector<Pose2>& poses,
                                      const DriveOdometry& odometry, const ReadCloud& read,
                                      const matching::MatcherConfig& config, const KnownLook& known,
                                      LookMemory* memory, const DriveHeights& heights_m) {
  return in_tree_order(Neighbours(poses, odometry, read, config, known, memory, heights_m).join());
}

}  // namespace voxlist::mapping
