#include "voxlist/mapping/map_views.h"

#include <algorithm>

#include "voxlist/io/clouds/cloud_file.h"
#include "voxlist/io/poses/trajectory.h"

namespace voxlist::mapping {

namespace {

// The highest that a robot is: what is free above that does not matter to it.
constexpr double kRobot_m = 2.0;

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
                     const drawing::ClosedLoops& closed) {
  drawing::MapView view;
  view.occupied = centres_of(map.occupied);
  view.resolution_m = map.occupied.resolution_m();
  for (const StampedPose3& pose : trajectory) view.path.push_back(pose.pose.translation());
  view.free = free_squares(map.passed, view.path);
  view.free_m = map.passed.resolution_m();
  view.closed = closed;

  io::write_tum(folder / "trajectory.tum", trajectory);
  io::write_ply(folder / "map.ply", view.occupied, io::colours_by_height(view.occupied));
  drawing::draw_map(view).write_png(folder / "map.png");
}

}  // namespace voxlist::mapping
