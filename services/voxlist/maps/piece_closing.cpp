#include "services/voxlist/maps/piece_closing.h"

#include <algorithm>
#include <numeric>

#include "voxlist/geometry/tilt.h"
#include "voxlist/mapping/graph/pose_graph.h"

namespace voxlist::desk {
namespace {

using Poses = std::vector<Pose2>;

std::vector<std::size_t> by_time(const std::vector<StampedPose3>& keyframes,
                                 std::size_t first_session) {
  std::vector<std::size_t> order(keyframes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto earlier = [&](std::size_t a, std::size_t b) {
    return keyframes[a].utime_us < keyframes[b].utime_us;
  };
  const auto second = order.begin() + static_cast<std::ptrdiff_t>(first_session);
  std::stable_sort(order.begin(), second, earlier);
  std::stable_sort(second, order.end(), earlier);
  return order;
}

// Poses in the piece's own order, from those in the order of time, with its first keyframe where it
// was.
Poses in_piece(const Poses& closed, const std::vector<std::size_t>& order, const Pose2& first) {
  Poses poses(closed.size());
  for (std::size_t i = 0; i < order.size(); ++i) poses[order[i]] = closed[i];
  const Pose2 back = first * poses.front().inverse();
  for (Pose2& pose : poses) pose = mapping::rounded(back * pose);
  poses.front() = first;
  return poses;
}

}  // namespace

Cloud level_cloud(mapping::KeyframeSpool& spool, const mapping::SpooledKeyframe& keyframe) {
  Cloud cloud = spool.read(keyframe).cloud;
  const Tilt tilt = tilt_of(keyframe.T_map_base);
  return tilt == Tilt{} ? cloud : moved(to_level(tilt), cloud);
}

PieceClosing close_piece(Piece& piece, mapping::KeyframeSpool& spool,
                         const matching::MatcherConfig& config) {
  const std::vector<std::size_t> order = by_time(piece.builder().poses(), piece.first_session());
  const auto& keyframes = piece.keyframes();
  Poses before;
  mapping::DriveOdometry odometry;
  for (const std::size_t i : order) {
    before.push_back(to_pose2(keyframes[i].T_map_base));
    odometry.push_back(keyframes[i].T_odom_base);
  }
  const mapping::MapClosing closed = mapping::close_map(
      before, odometry, [&](std::size_t i) { return level_cloud(spool, keyframes[order[i]]); },
      config);
  PieceClosing closing{closed.loops, closed.refused};
  if (!closed.moves) return closing;
  const Poses poses = in_piece(closed.poses, order, to_pose2(keyframes.front().T_map_base));
  for (std::size_t i = 0; i < order.size(); ++i)
    closing.moved_m = std::max(closing.moved_m, distance_m(before[i], poses[order[i]]));
  piece.move_keyframes(poses);
  return closing;
}

}  // namespace voxlist::desk
