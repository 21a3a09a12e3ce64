#include "services/voxlist/recording/given_poses.h"

#include <fmt/core.h>

#include "voxlist/io/files/file.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::desk {
namespace {

// Poses that start farther from the origin than this (m) are in coordinates of a country, not of a
// building: a float has steps of 0.03 m at 500 km, and an OctoMap of 0.1 m ends at 3.2 km.
constexpr double kFar_m = 1000.0;

Eigen::Vector3d offset_of(const io::PoseTable& table) {
  const Eigen::Vector3d first = table.rows.front().pose.translation();
  return first.cwiseAbs().maxCoeff() > kFar_m ? first.array().round().matrix().eval()
                                              : Eigen::Vector3d::Zero();
}

void check_reach(const std::filesystem::path& path, const io::PoseTable& table) {
  for (const io::PoseRow& row : table.rows) {
    const Eigen::Vector3d p = row.pose.translation();
    if (in_lattice(p, kFinestResolution_m)) continue;
    throw io::FileError(
        path, fmt::format("pose {} lies {:.0f} km from the origin, farther than a map reaches "
                          "({:.0f} km): take an offset of ({:.0f}, {:.0f}, {:.0f}) off, or map the "
                          "places one by one",
                          row.scan, p.norm() / 1000.0, kVoxelLimit * kFinestResolution_m / 1000.0,
                          p.x(), p.y(), p.z()));
  }
}

}  // namespace

GivenPoses::GivenPoses(const std::filesystem::path& path, const ScanInput& input, Console& console)
    : table_(io::read_poses(path)),
      row_of_(input.match(table_)),
      has_times_(input.has_times()),
      offset_m_(offset_of(table_)) {
  if (!offset_m_.isZero()) {
    console.warn(fmt::format(
        "{}: the poses lie {:.0f} km from the origin, as in UTM: an offset of "
        "({:.0f}, {:.0f}, {:.0f}) m is taken off",
        path.string(), offset_m_.norm() / 1000.0, offset_m_.x(), offset_m_.y(), offset_m_.z()));
  }
  for (io::PoseRow& row : table_.rows) row.pose.translation() -= offset_m_;
  check_reach(path, table_);
}

}  // namespace voxlist::desk
