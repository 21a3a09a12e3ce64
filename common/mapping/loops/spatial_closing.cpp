#include "voxlist/mapping/loops/spatial_closing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <mutex>
#include <span>

#include "voxlist/geometry/angle.h"
#include "voxlist/mapping/graph/spatial_graph.h"

namespace voxlist::mapping {
namespace {

// What clouds that are held against each other have in common and do not tell grows with the root
// of the way (m, rad at 1 m), as in the plane (neighbours.cpp).
constexpr double kDrift_m = 0.004, kDrift_rad = 0.0004;
// What local maps of long before are off by in themselves (m, rad), as in loop_search.cpp.
constexpr double kLocal_m = 0.02, kLocal_rad = 0.002;
// A loop may be as far off in height (m): what the way drifted by. A judgement: half a table.
constexpr double kHeight_m = 0.3;
// Keyframes round the other end of a loop that the scan is held against, too.
constexpr std::size_t kRound = 2;
// A map misses an edge by more than chance from this on: 1 of 150 (chi squared, six degrees of
// freedom).
constexpr double kMissed2 = 17.9;
constexpr double kMoved_m = 0.01, kTurned_rad = 0.1 * kRadPerDeg;

// Where x, y and yaw are among six coordinates.
constexpr int kPlanar[] = {0, 1, 5};

Six variances(double shift_m, double turn_rad) {
  Six all = Six::Constant(turn_rad * turn_rad);
  all.head<3>().setConstant(shift_m * shift_m);
  return all;
}

// What surfaces say together with odometry, unless the two contradict: wheels slip.
UncertainPose3 with_odometry(const UncertainPose3& seen, const UncertainPose& told) {
  Eigen::Matrix<double, 3, 6> planar = Eigen::Matrix<double, 3, 6>::Zero();
  for (int i = 0; i < 3; ++i) planar(i, kPlanar[i]) = 1.0;
  const Eigen::Matrix3d both = planar * seen.covariance * planar.transpose() + told.covariance;
  const Eigen::Matrix<double, 6, 3> gain = seen.covariance * planar.transpose() * both.inverse();
  const Pose2 off = to_pose2(seen.pose);
  if (mahalanobis2(off, {told.pose, both}) > 3.5 * 3.5) return seen;
  const Eigen::Vector3d more(told.pose.x_m - off.x_m, told.pose.y_m - off.y_m,
                             wrap_angle(told.pose.yaw_rad - off.yaw_rad));
  const Six2 left = Six2::Identity() - gain * planar;
  const Six2 covariance = left * seen.covariance;
  return {stepped(seen.pose, gain * more), 0.5 * (covariance + covariance.transpose())};
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
    for (const auto& keyframe : keyframes) odometry_.push_back(keyframe.T_odom_keyframe);
  }

  UncertainPose3 in_space(const PoseEdge& planar, bool is_drive) const {
    const auto found = looked(look(planar, is_drive));
    if (!found) return lifted(planar.T_from_to);
    UncertainPose3 seen = *found;
    const double away_m = distance_m(planar.T_from_to.pose, {});
    seen.covariance.diagonal() += is_drive ? Six((1.0 + away_m) * variances(kDrift_m, kDrift_rad))
                                           : variances(kLocal_m, kLocal_rad);
    const auto told = is_drive ? odometry_step(odometry_, planar.from, planar.to) : std::nullopt;
    return told ? with_odometry(seen, *told) : seen;
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
  DriveOdometry odometry_;
};

// Poses far from the answer come nearer by Cauchy's kernel first: Geman and McClure's would let go
// of right loops from there.
std::vector<Pose3> solved(const std::vector<Pose3>& start, std::span<const SpatialEdge> edges,
                          std::size_t drive) {
  const auto trusted = edges.first(drive), doubted = edges.subspan(drive);
  return solve(solve(start, trusted, doubted, Kernel::kCauchy), trusted, doubted,
               Kernel::kGemanMcClure);
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
  const bool missed = std::any_of(edges.begin(), edges.end(), [&](const SpatialEdge& edge) {
    return distance2(edge, start) > kMissed2;
  });
  const bool off = !std::equal(start.begin(), start.end(), poses.begin(), std::not_fn(is_off));
  closing.moves = closing.moves || (missed && off);
  if (closing.moves) take(poses, known_tilt(keyframes, 0), closing);
}

}  // namespace voxlist::mapping
