#include "voxlist/mapping/graph/loop_closing.h"

#include "voxlist/mapping/graph/pose_graph.h"

namespace voxlist::mapping {
namespace {

std::vector<Pose2> by_drive(const PoseTree& tree, const Pose2& first) {
  std::vector<Pose2> poses;
  const Pose2 T_map_root = first * tree.pose(0).inverse();
  for (std::size_t i = 0; i < tree.size(); ++i) poses.push_back(T_map_root * tree.pose(i));
  return poses;
}

std::vector<PoseEdge> edges_of(std::span<const Loop> loops) {
  std::vector<PoseEdge> edges;
  for (const Loop& loop : loops) edges.push_back(loop.edge);
  return edges;
}

}  // namespace

ClosedDrive close_loops(const PoseTree& tree, std::span<const PoseEdge> drive,
                        std::span<const Loop> loops, const Pose2& first) {
  const std::vector<Pose2> start = by_drive(tree, first);
  const std::vector<Loop> chosen = choose_loops(tree, loops);
  std::vector<Loop> refused = refused_loops(tree, loops);
  if (chosen.empty()) return {start, {}, std::move(refused)};
  const std::vector<PoseEdge> edges = edges_of(chosen);
  // Poses far from the answer come nearer by Cauchy's kernel first: Geman and McClure's would let
  // go of right loops from there.
  const std::vector<Pose2> near = solve(start, drive, edges, Kernel::kCauchy);
  const std::vector<Pose2> nearer = solve(near, drive, edges, Kernel::kGemanMcClure);
  const std::vector<Loop> kept = keep_fitting(tree, nearer, chosen);
  if (kept.empty()) return {start, {}, std::move(refused)};
  return {solve(nearer, drive, edges_of(kept), Kernel::kGemanMcClure), kept, std::move(refused)};
}

}  // namespace voxlist::mapping
