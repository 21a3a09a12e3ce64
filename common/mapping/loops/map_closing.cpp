#include "voxlist/mapping/loops/map_closing.h"

#include <algorithm>
#include <mutex>

#include "voxlist/mapping/graph/loop_closing.h"
#include "voxlist/mapping/graph/pose_graph.h"
#include "voxlist/mapping/loops/loop_search.h"
#include "voxlist/mapping/loops/neighbours.h"

namespace voxlist::mapping {
namespace {

// A map misses an edge by more than chance from so many standard deviations (squared) on: 1 of 150
// (three degrees of freedom).
constexpr double kMissed2 = 3.5 * 3.5;

// Neighbours that are farther apart (m) may share too little for a match to tell their step. Scans
// of a drive are nearer; real stations that were, 11 to 22 m apart, stood up to 2 m off.
constexpr double kLongStep_m = 10.0;

bool has_long_step(const std::vector<Pose2>& poses) {
  return std::adjacent_find(poses.begin(), poses.end(), [](const Pose2& a, const Pose2& b) {
           return distance_m(a, b) > kLongStep_m;
         }) != poses.end();
}

// Whether some keyframe may see ground of long before, by the way in the order of time.
bool may_come_back(const std::vector<Pose2>& poses, double sight_m) {
  std::vector<double> way_m{0.0};
  for (std::size_t i = 1; i < poses.size(); ++i)
    way_m.push_back(way_m.back() + distance_m(poses[i - 1], poses[i]));
  for (std::size_t b = 0; b < poses.size(); ++b)
    for (std::size_t a = 0; a < b; ++a)
      if (const double away_m = distance_m(poses[a], poses[b]);
          away_m <= sight_m && is_long_way(way_m[b] - way_m[a], away_m))
        return true;
  return false;
}

bool misses(const std::vector<Pose2>& poses, const PoseEdge& edge) {
  return distance2(edge, poses) > kMissed2;
}

// Whether the map, as it is, misses loops, or was torn where it met its own old ground.
bool is_open(const std::vector<Pose2>& poses, const std::vector<PoseEdge>& drive,
             const std::vector<Loop>& loops) {
  const auto missed = [&](const auto& edge) { return misses(poses, edge); };
  return std::any_of(drive.begin(), drive.end(), missed) ||
         std::any_of(loops.begin(), loops.end(),
                     [&](const Loop& loop) { return missed(loop.edge); });
}

// Reads for several threads, one at a time.
ReadCloud one_by_one(const ReadCloud& read, std::mutex& mutex) {
  return [&read, &mutex](std::size_t keyframe) {
    const std::lock_guard lock(mutex);
    return read(keyframe);
  };
}

}  // namespace

MapClosing close_map(const std::vector<Pose2>& poses, const DriveOdometry& odometry,
                     const ReadCloud& read_cloud, const matching::MatcherConfig& config,
                     const KnownLook& known, LookMemory* memory, const DriveHeights& heights_m) {
  MapClosing closing;
  closing.poses = poses;
  if (!has_long_step(poses) && !may_come_back(poses, config.scan.max_range_m)) return closing;
  std::mutex mutex;
  const ReadCloud read = one_by_one(read_cloud, mutex);
  const std::vector<PoseEdge> drive =
      join_neighbours(poses, odometry, read, config, known, memory, heights_m);
  const PoseTree tree(poses.size(), drive);
  const ClosedDrive closed =
      close_loops(tree, drive, find_loops(tree, read, config, memory, heights_m), poses.front());
  closing.refused = closed.refused.size();
  closing.edges = drive;
  for (const Loop& loop : closed.loops) closing.edges.push_back(loop.edge);
  if (closed.loops.empty() || !is_open(poses, drive, closed.loops)) return closing;
  closing.loops = closed.loops.size();
  closing.moves = true;
  std::transform(closed.poses.begin(), closed.poses.end(), closing.poses.begin(), rounded);
  return closing;
}

}  // namespace voxlist::mapping
