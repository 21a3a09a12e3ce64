#include "voxlist/mapping/loops/spatial_closing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <mutex>
#include <span>

#include "voxlist/geometry/angle.h"
#include "voxlist/mapping/graph/spatial_graph.h"

namespace voxlist::mapping {
namespace {

// What height and lean drift by from one tracked keyframe to the next grows with the root of the
// way (m, rad at 1 m): twice what the plane does (neighbours.cpp), where walls are held on to for
// longer than a floor is in sight.
constexpr double kDrift_m = 0.008, kDrift_rad = 0.001;
// What a single cloud's floor is off by beside what a look at it tells (m, rad): of real scans,
// looks at neighbours' leans were off by 0.25 deg, and as tracked by 0.08.
constexpr double kFloor_m = 0.01, kFloor_rad = 0.004;
// What local maps of long before are off by in themselves (m, rad), as in loop_search.cpp.
constexpr double kLocal_m = 0.02, kLocal_rad = 0.002;
// A loop may be as far off in height (m): what the way drifted by. A judgement: half a table.
constexpr double kHeight_m = 0.3;
// Keyframes round the other end of a loop that the scan is held against, too.
constexpr std::size_t kRound = 2;
// A map misses one edge by more than chance from this on: 1 of 150 (chi squared, six degrees of
// freedom).
constexpr double kMissed2 = 17.9;
constexpr double kMoved_m = 0.01, kTurned_rad = 0.1 * kRadPerDeg;

// Where height, roll and pitch are among six coordinates.
constexpr int kTilt = 2;
using TiltMatrix = Eigen::Matrix3d;

Eigen::DiagonalMatrix<double, 3> tilt_variances(double shift_m, double turn_rad) {
  return Eigen::Vector3d(shift_m, turn_rad, turn_rad).cwiseAbs2().asDiagonal();
}

// Height, roll and pitch as a look has them; x, y and yaw, which the way in the plane tells better,
// as that does.
UncertainPose3 in_plane_and_space(const UncertainPose& planar, const UncertainPose3& seen) {
  UncertainPose3 both = lifted(planar);
  both.pose = to_pose3(planar.pose, tilt_of(seen.pose));
  both.covariance.block<3, 3>(kTilt, kTilt) =
      seen.covariance.block<3, 3>(kTilt, kTilt) + TiltMatrix(tilt_variances(kFloor_m, kFloor_rad));
  return both;
}

// A step together with height, roll and pitch as they were tracked, unless the two contradict: each
// keyframe was tracked on the floor of many, and only drifts from one to the next. Where the map
// met ground of long before, it may be torn.
UncertainPose3 with_tracked(const UncertainPose3& seen, double way_m) {
  const TiltMatrix tracked = (1.0 + way_m) * TiltMatrix(tilt_variances(kDrift_m, kDrift_rad));
  const TiltMatrix told = seen.covariance.block<3, 3>(kTilt, kTilt);
  const Six off = miss(seen.pose, Pose3::Identity(), to_pose3(to_pose2(seen.pose)));
  const Eigen::Vector3d less = off.segment<3>(kTilt);
  const TiltMatrix gain = told * TiltMatrix(told + tracked).inverse();
  if (less.dot(TiltMatrix(told + tracked).inverse() * less) > 3.5 * 3.5) return seen;
  Six step = Six::Zero();
  step.segment<3>(kTilt) = gain * less;
  UncertainPose3 both{stepped(seen.pose, step), seen.covariance};
  both.covariance.block<3, 3>(kTilt, kTilt) = gain * tracked;
  return both;
}

Tilt known_tilt(const MapKeyframes& keyframes, std::size_t keyframe) {
  return keyframes[keyframe].tilt.value_or(Tilt{});
}

// Tells edges in space, between level frames.
class SpaceLooks {
 public:
  // `poses`: where keyframes stand, by which those beside an edge's end are known.
  SpaceLooks(const MapKeyframes& keyframes, const ReadCloud& read,
             const matching::MatcherConfig& config, const std::vector<Pose2>& poses,
             LookMemory* memory)
      : keyframes_(keyframes),
        read_(read),
        config_(config),
        poses_(poses),
        memory_(memory),
        order_(order_of_drive(keyframes)),
        place_(order_.size()) {
    for (std::size_t i = 0; i < order_.size(); ++i) place_[order_[i]] = i;
  }

  UncertainPose3 in_space(const PoseEdge& planar, bool is_drive) const {
    const auto found = looked(look(planar, is_drive));
    if (!found) return lifted(planar.T_from_to);
    UncertainPose3 seen = in_plane_and_space(planar.T_from_to, *found);
    if (is_drive) return with_tracked(seen, distance_m(planar.T_from_to.pose, {}));
    seen.covariance.block<3, 3>(kTilt, kTilt) += TiltMatrix(tilt_variances(kLocal_m, kLocal_rad));
    return seen;
  }

 private:
  Tilt tilt(std::size_t keyframe) const { return known_tilt(keyframes_, keyframe); }

  SpatialLook look(const PoseEdge& planar, bool is_drive) const {
    SpatialLook look{
        planar.to, tilt(planar.to), planar.T_from_to.pose, is_drive ? 0.0 : kHeight_m, {}};
    look.others.push_back({planar.from, {}, tilt(planar.from)});
    for (std::size_t i = 1; !is_drive && i <= kRound; ++i)
      for (const std::size_t near : {place_[planar.from] - i, place_[planar.from] + i})
        if (near < order_.size()) add(planar.from, order_[near], planar.to, look);
    return look;
  }

  // One that stands beside it, unless it is the other end.
  void add(std::size_t from, std::size_t near, std::size_t to, SpatialLook& look) const {
    constexpr double kNear_m = 5.0;
    const Pose2 T_from_near = poses_[from].inverse() * poses_[near];
    if (near != to && distance_m(T_from_near, {}) <= kNear_m)
      look.others.push_back({near, T_from_near, tilt(near)});
  }

  std::optional<UncertainPose3> looked(const SpatialLook& look) const {
    if (memory_)
      if (const auto known = memory_->in_space(look)) return known->found;
    const auto found = look_in_space(look, read_, config_);
    if (memory_) memory_->keep({look, found});
    return found;
  }

  const MapKeyframes& keyframes_;
  const ReadCloud& read_;
  const matching::MatcherConfig& config_;
  const std::vector<Pose2>& poses_;
  LookMemory* const memory_;
  const std::vector<std::size_t> order_;
  std::vector<std::size_t> place_;
};

// All loops were believed in the plane, so poses come near the answer by what all of them say; then
// those may be let go of that say another height.
std::vector<Pose3> solved(const std::vector<Pose3>& start, std::span<const SpatialEdge> edges,
                          std::size_t drive) {
  const auto trusted = edges.first(drive), doubted = edges.subspan(drive);
  return solve(solve(start, edges), trusted, doubted, Kernel::kGemanMcClure);
}

// The first keyframe stays, bit for bit.
void take(const std::vector<Pose3>& poses, const Tilt& first, SessionClosing& closing) {
  closing.tilts = {first};
  for (std::size_t i = 1; i < poses.size(); ++i) {
    closing.poses[i] = rounded(to_pose2(poses[i]));
    closing.tilts.push_back(rounded(tilt_of(poses[i])));
  }
}

bool is_off(const Pose3& a, const Pose3& b) {
  const Six off = miss(Pose3::Identity(), a, b);
  return off.head<3>().norm() > kMoved_m || off.tail<3>().norm() > kTurned_rad;
}

}  // namespace

bool is_in_space(const MapKeyframes& keyframes) {
  return std::any_of(keyframes.begin(), keyframes.end(), [](const auto& keyframe) {
    return keyframe.tilt && *keyframe.tilt != Tilt{};
  });
}

void tell_in_space(const MapKeyframes& keyframes, const ReadCloud& read,
                   const matching::MatcherConfig& config, const std::vector<Pose2>& poses,
                   std::vector<PoseEdge>& edges, LookMemory* memory) {
  std::mutex mutex;
  const ReadCloud one_by_one = [&](std::size_t keyframe) {
    const std::lock_guard lock(mutex);
    return read(keyframe);
  };
  const SpaceLooks looks(keyframes, one_by_one, config, poses, memory);
  const std::size_t drive = keyframes.size() - 1;
  tbb::parallel_for(std::size_t{0}, edges.size(), [&](std::size_t i) {
    PoseEdge& edge = edges[i];
    edge.in_space =
        between_leaning(looks.in_space(edge, i < drive), known_tilt(keyframes, edge.from),
                        known_tilt(keyframes, edge.to));
  });
}

void close_in_space(const MapKeyframes& keyframes, SessionClosing& closing) {
  std::vector<SpatialEdge> edges;
  for (const PoseEdge& edge : closing.edges) edges.push_back({edge.from, edge.to, *edge.in_space});
  std::vector<Pose3> start;
  for (std::size_t i = 0; i < keyframes.size(); ++i)
    start.push_back(to_pose3(closing.poses[i], known_tilt(keyframes, i)));
  const std::vector<Pose3> poses = solved(start, edges, keyframes.size() - 1);
  const double most = worst_by_chance(kMissed2, edges.size());
  const bool missed = std::any_of(edges.begin(), edges.end(), [&](const SpatialEdge& edge) {
    return distance2(edge, start) > most;
  });
  const bool off = !std::equal(start.begin(), start.end(), poses.begin(), std::not_fn(is_off));
  closing.moves = closing.moves || (missed && off);
  if (closing.moves) take(poses, known_tilt(keyframes, 0), closing);
}

}  // namespace voxlist::mapping
