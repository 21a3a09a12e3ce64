#include <fmt/core.h>

#include "services/voxlist/report/run/folder.h"
#include "services/voxlist/report/run/surface_distance.h"
#include "voxlist/evaluation/association.h"
#include "voxlist/evaluation/evaluation.h"

namespace voxlist::desk {
namespace {

struct Pair {
  VoxelMap made, wanted;
};

void add(const Cloud& cloud, const Pose3& pose, VoxelMap& map) {
  for (const Eigen::Vector3f& point : cloud.points) {
    const Eigen::Vector3d there = pose * point.cast<double>();
    if (in_lattice(there, map.resolution_m())) map.insert(voxel_at(there, map.resolution_m()));
  }
}

}  // namespace

Entry run_surfaces(const MapFolder& folder, const io::PoseTable& truth) {
  std::vector<StampedPose3> poses;
  for (const mapping::Keyframe& keyframe : folder.keyframes)
    poses.push_back({keyframe.cloud.utime_us, keyframe.T_map_base});
  const auto errors = evaluation::evaluate(poses, truth);
  Entry entry{"surfaces", "Accuracy and completeness of the map"};
  if (!errors) {
    entry.differs = "No keyframe has a true pose.";
    return entry;
  }
  // The truth, moved to where the trajectory fits it best.
  const Pose3 T_map_truth = to_pose3(errors->T_truth_estimate.inverse());
  Pair maps;
  const auto pairs = evaluation::associate(poses, truth).pairs;
  for (const auto& [in_truth, in_poses] : pairs) {
    const Cloud& cloud = folder.keyframes[in_poses].cloud;
    add(cloud, poses[in_poses].pose, maps.made);
    add(cloud, T_map_truth * truth.rows[in_truth].pose, maps.wanted);
  }
  entry.setup = fmt::format(
      "{} of {} keyframes have a true pose. Their points in voxels of 0.02 m where the run put "
      "them, "
      "against the same points at the true poses, moved to where these fit the run's best. "
      "Accuracy: voxels of the run's map that have one of the true map within the distance. "
      "Completeness: the other way round.",
      pairs.size(), poses.size());
  const auto accuracy = shares_near(maps.made, maps.wanted);
  const auto completeness = shares_near(maps.wanted, maps.made);
  Table table{"", {"within", "accuracy", "completeness"}, {}};
  for (std::size_t i = 0; i < kNear_m.size(); ++i)
    table.rows.push_back({fmt::format("{:.2f} m", kNear_m[i]),
                          fmt::format("{:.2f} %", 100.0 * accuracy[i]),
                          fmt::format("{:.2f} %", 100.0 * completeness[i])});
  entry.tables = {table};
  return entry;
}

}  // namespace voxlist::desk
