#include "voxlist/mapping/loops/session_closing.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <span>

#include "voxlist/geometry/tilt.h"
#include "voxlist/mapping/graph/pose_graph.h"
#include "voxlist/mapping/loops/neighbours.h"
#include "voxlist/mapping/loops/spatial_closing.h"

namespace voxlist::mapping {
namespace {

using Order = std::vector<std::size_t>;

// Poses in the file's order, from those in the order of the drive, with the map's first keyframe
// where it was.
std::vector<Pose2> in_file(const std::vector<Pose2>& closed, const Order& order,
                           const Pose2& first) {
  std::vector<Pose2> poses(closed.size());
  for (std::size_t i = 0; i < order.size(); ++i) poses[order[i]] = closed[i];
  const Pose2 back = first * poses.front().inverse();
  for (Pose2& pose : poses) pose = rounded(back * pose);
  poses.front() = first;
  return poses;
}

std::vector<PoseEdge> in_file(std::vector<PoseEdge> edges, const Order& order) {
  for (PoseEdge& edge : edges) {
    edge.from = order[edge.from];
    edge.to = order[edge.to];
  }
  return edges;
}

// Keyframes and looks in the order of the drive.
struct Drive {
  Order order;
  std::vector<Pose2> poses;
  DriveOdometry odometry;
  DriveHeights heights_m;
  ReadCloud read;
  KnownLook known;
};

Drive drive_of(const MapKeyframes& keyframes, const ReadCloud& read, const KnownLook& known) {
  Drive drive{order_of_drive(keyframes), {}, {}, {}, {}, {}};
  for (const std::size_t i : drive.order) {
    drive.poses.push_back(keyframes[i].T_map_keyframe);
    drive.odometry.push_back(keyframes[i].T_odom_keyframe);
    drive.heights_m.push_back(keyframes[i].tilt.value_or(Tilt{}).z_m);
  }
  drive.read = [&read, order = drive.order](std::size_t i) { return read(order[i]); };
  if (known)
    drive.known = [&known, order = drive.order](std::size_t from, std::size_t to) {
      return known(order[from], order[to]);
    };
  return drive;
}

// How far keyframes are moved, and turned, along and about the axis where that is most.
void tell_motion(const MapKeyframes& before, SessionClosing& closing) {
  const MapKeyframes after = moved(before, closing);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Pose2 &was = before[i].T_map_keyframe, &is = after[i].T_map_keyframe;
    const Tilt from = before[i].tilt.value_or(Tilt{}), to = after[i].tilt.value_or(Tilt{});
    closing.moved_m = std::max({closing.moved_m, distance_m(was, is), std::abs(to.z_m - from.z_m)});
    closing.turned_rad =
        std::max({closing.turned_rad, turn_rad(was, is), std::abs(to.roll_rad - from.roll_rad),
                  std::abs(to.pitch_rad - from.pitch_rad)});
  }
}

}  // namespace

MapKeyframes moved(MapKeyframes keyframes, const SessionClosing& closing) {
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    keyframes[i].T_map_keyframe = closing.poses[i];
    if (!closing.tilts.empty()) keyframes[i].tilt = closing.tilts[i];
  }
  return keyframes;
}

Order order_of_drive(const MapKeyframes& keyframes) {
  std::vector<int> session(keyframes.size(), 0);
  for (std::size_t i = 1; i < keyframes.size(); ++i)
    session[i] = session[i - 1] + int{keyframes[i].begins_session};
  Order order(keyframes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(session[a], keyframes[a].utime_us) <
           std::pair(session[b], keyframes[b].utime_us);
  });
  return order;
}

SessionClosing close_sessions(const MapKeyframes& keyframes, const ReadCloud& read,
                              const matching::MatcherConfig& config, const KnownLook& known,
                              LookMemory* memory) {
  const Drive drive = drive_of(keyframes, read, known);
  const MapClosing closed = close_map(drive.poses, drive.odometry, drive.read, config, drive.known,
                                      memory, drive.heights_m);
  SessionClosing closing;
  closing.refused = closed.refused;
  closing.edges = in_file(closed.edges, drive.order);
  closing.moves = closed.moves;
  for (const auto& keyframe : keyframes) closing.poses.push_back(keyframe.T_map_keyframe);
  if (closed.moves)
    closing.poses = in_file(closed.poses, drive.order, keyframes.front().T_map_keyframe);
  if (is_in_space(keyframes))
    tell_in_space(keyframes, read, config, closing.poses, closing.edges, memory);
  const bool has_loops = closing.edges.size() >= keyframes.size();
  if (has_loops && is_in_space(keyframes)) close_in_space(keyframes, closing);
  if (closing.moves) closing.loops = closing.edges.size() + 1 - keyframes.size();
  if (closing.moves) tell_motion(keyframes, closing);
  return closing;
}

std::vector<PoseEdge> drive_edges(const MapKeyframes& keyframes, const ReadCloud& read,
                                  const matching::MatcherConfig& config, const KnownLook& known) {
  std::mutex mutex;
  const ReadCloud one_by_one = [&](std::size_t keyframe) {
    const std::lock_guard lock(mutex);
    return read(keyframe);
  };
  const Drive drive = drive_of(keyframes, one_by_one, known);
  std::vector<PoseEdge> edges =
      in_file(join_neighbours(drive.poses, drive.odometry, drive.read, config, drive.known, nullptr,
                              drive.heights_m),
              drive.order);
  if (is_in_space(keyframes)) {
    std::vector<Pose2> poses(keyframes.size());
    std::transform(keyframes.begin(), keyframes.end(), poses.begin(),
                   [](const auto& keyframe) { return keyframe.T_map_keyframe; });
    tell_in_space(keyframes, read, config, poses, edges);
  }
  return edges;
}

drawing::ClosedLoops drawn(const MapKeyframes& before, const SessionClosing& closing) {
  drawing::ClosedLoops drawn;
  if (!closing.moves) return drawn;
  const auto place = [](const Pose2& pose) { return Eigen::Vector2d(pose.x_m, pose.y_m); };
  for (const auto& keyframe : before) drawn.before.push_back(place(keyframe.T_map_keyframe));
  for (const PoseEdge& loop : std::span(closing.edges).last(closing.loops))
    drawn.loops.push_back({place(closing.poses[loop.from]), place(closing.poses[loop.to])});
  return drawn;
}

Cloud level_cloud(const Keyframe& keyframe) {
  const Tilt tilt = tilt_of(keyframe.T_map_base);
  return tilt == Tilt{} ? keyframe.cloud : moved(to_level(tilt), keyframe.cloud);
}

}  // namespace voxlist::mapping
