#include "voxlist/mapping/map_views.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <span>

#include "voxlist/io/clouds/cloud_file.h"
#include "voxlist/io/poses/trajectory.h"
#include "voxlist/mapping/graph/pose_covariances.h"

namespace voxlist::mapping {

namespace {

// The highest that a robot is: what is free above that does not matter to it.
constexpr double kRobot_m = 2.0;

// What a scan that was tracked beside a keyframe is less sure than that by (m, rad): what maps of
// few keyframes are off by in themselves.
constexpr double kBeside_m = 0.02, kBeside_rad = 0.002;

// Cells of twice the edge that hold a voxel.
VoxelMap coarser(const VoxelMap& map) {
  VoxelMap cells(2.0 * map.resolution_m());
  map.for_each_voxel([&](const Voxel& v) { cells.insert({v.x >> 1, v.y >> 1, v.z >> 1}); });
  return cells;
}

// A map of no more cells than people can look at.
struct Viewed {
  const VoxelMap* map;
  std::optional<VoxelMap> coarse = std::nullopt;

  Viewed(const VoxelMap& whole, std::size_t most) : map(&whole) {
    while (map->size() > most) {
      coarse = coarser(*map);
      map = &*coarse;
    }
  }
  Viewed(const Viewed&) = delete;
  Viewed& operator=(const Viewed&) = delete;
};

Eigen::Vector3f centre_of(const Voxel& voxel, const VoxelMap& map) {
  return center(voxel, map.resolution_m()).cast<float>();
}

std::vector<Eigen::Vector3f> centres_of(const VoxelMap& map) {
  std::vector<Eigen::Vector3f> centres;
  centres.reserve(map.size());
  map.for_each_voxel([&](const Voxel& v) { centres.push_back(centre_of(v, map)); });
  return centres;
}

// Squares of the floor plan above which rays went, as high as a robot is: the path is on the floor.
std::vector<Eigen::Vector2f> free_squares(const VoxelMap& passed,
                                          const std::vector<Eigen::Vector3d>& path) {
  const auto lower = [](const auto& a, const auto& b) { return a.z() < b.z(); };
  if (path.empty()) return {};
  const auto [lowest, highest] = std::ranges::minmax_element(path, lower);
  const double low_m = lowest->z(), high_m = highest->z() + kRobot_m;
  VoxelMap plan(passed.resolution_m());
  passed.for_each_voxel([&](const Voxel& v) {
    const double height_m = center(v, passed.resolution_m()).z();
    if (height_m > low_m && height_m < high_m) plan.insert({v.x, v.y, 0});
  });
  std::vector<Eigen::Vector2f> squares;
  plan.for_each_voxel([&](const Voxel& v) { squares.push_back(centre_of(v, plan).head<2>()); });
  return squares;
}

}  // namespace

void write_map_views(const std::filesystem::path& folder, const OccupancyMap& map,
                     const std::vector<StampedPose3>& trajectory,
                     const drawing::ClosedLoops& closed, std::size_t most_voxels) {
  drawing::MapView view;
  {
    const Viewed viewed(map.occupied, most_voxels);
    view.occupied = centres_of(*viewed.map);
    view.resolution_m = viewed.map->resolution_m();
  }
  for (const StampedPose3& pose : trajectory) view.path.push_back(pose.pose.translation());
  view.free = free_squares(map.passed, view.path);
  view.free_m = map.passed.resolution_m();
  view.closed = closed;

  std::error_code ignored;
  std::filesystem::remove(folder / kCovarianceFile, ignored);
  io::write_tum(folder / "trajectory.tum", trajectory);
  io::write_ply(folder / "map.ply", view.occupied, io::colours_by_height(view.occupied),
                fmt::format("voxels of {:g} m", view.resolution_m));
  drawing::draw_map(view).write_png(folder / "map.png");
}

void write_covariances(const std::filesystem::path& folder, const StoredGraph& graph,
                       const std::vector<StampedPose3>& trajectory) {
  const std::size_t drive = graph.keyframes.size() - 1;
  if (graph.keyframes.empty() || graph.edges.size() < drive) return;
  std::vector<Pose2> poses;
  std::vector<StampedPose3> keyframes;
  for (const StoredGraph::Keyframe& keyframe : graph.keyframes) {
    poses.push_back(keyframe.T_map_keyframe);
    keyframes.push_back({keyframe.utime_us, to_pose3(keyframe.T_map_keyframe)});
  }
  const std::span<const PoseEdge> edges(graph.edges);
  const auto sure = covariances(poses, edges.first(drive), edges.subspan(drive));
  io::write_covariances(
      folder / kCovarianceFile, trajectory,
      covariances_of(trajectory, keyframes, sure, {kBeside_m, kBeside_m, kBeside_rad}));
}

}  // namespace voxlist::mapping
