#include "mapping/map_views.h"

#include "io/cloud_file.h"
#include "io/map_picture.h"
#include "io/trajectory.h"

namespace voxlist {

void write_map_views(const std::filesystem::path& folder, const VoxelMap& map,
                     const std::vector<StampedPose3>& trajectory) {
  std::vector<Eigen::Vector3f> centers;
  centers.reserve(map.size());
  map.for_each_voxel(
      [&](const Voxel& v) { centers.push_back(center(v, map.resolution_m()).cast<float>()); });
  std::vector<Pose2> path;
  for (const StampedPose3& pose : trajectory) path.push_back(to_pose2(pose.pose));

  write_tum(folder / "trajectory.tum", trajectory);
  write_ply(folder / "map.ply", centers, colours_by_height(centers));
  write_png(folder / "map.png", draw_map(centers, path, map.resolution_m()));
}

}  // namespace voxlist
