#include "voxlist/mapping/map_views.h"

#include "voxlist/drawing/map_picture.h"
#include "voxlist/io/clouds/cloud_file.h"
#include "voxlist/io/poses/trajectory.h"

namespace voxlist::mapping {

void write_map_views(const std::filesystem::path& folder, const VoxelMap& map,
                     const std::vector<StampedPose3>& trajectory) {
  std::vector<Eigen::Vector3f> centers;
  centers.reserve(map.size());
  map.for_each_voxel(
      [&](const Voxel& v) { centers.push_back(center(v, map.resolution_m()).cast<float>()); });
  std::vector<Eigen::Vector3d> path;
  for (const StampedPose3& pose : trajectory) path.push_back(pose.pose.translation());

  io::write_tum(folder / "trajectory.tum", trajectory);
  io::write_ply(folder / "map.ply", centers, io::colours_by_height(centers));
  drawing::draw_map(centers, path, map.resolution_m()).write_png(folder / "map.png");
}

}  // namespace voxlist::mapping
