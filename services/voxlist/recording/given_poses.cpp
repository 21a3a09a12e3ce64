#include "services/voxlist/recording/given_poses.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "voxlist/io/files/file.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::desk {
namespace {

// Poses that start farther from the origin than this (m) are in coordinates of a country, not of a
// building: a float has steps of 0.03 m at 500 km, and an OctoMap of 0.1 m ends at 3.2 km.
constexpr double kFar_m = 1000.0;

// Heights (m) that are no more than this are left as they are: half a voxel.
constexpr double kLevel_m = 0.01;

// Scans this far (m) above or below where the map is level are not found in it.
constexpr double kOtherLevel_m = 0.2;

double height_m(const io::PoseRow& row) { return row.pose.translation().z(); }

double median_height_m(const io::PoseTable& table) {
  std::vector<double> heights;
  for (const io::PoseRow& row : table.rows) heights.push_back(height_m(row));
  const auto middle = heights.begin() + std::ssize(heights) / 2;
  std::ranges::nth_element(heights, middle);
  return *middle;
}

// A robot finds itself at height 0: there is the map's median height, too.
Eigen::Vector3d offset_of(const io::PoseTable& table) {
  const Eigen::Vector3d first = table.rows.front().pose.translation();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  if (first.cwiseAbs().maxCoeff() > kFar_m) offset = first.array().round();
  const double height = median_height_m(table);
  offset.z() = std::abs(height) > kLevel_m ? height : 0.0;
  return offset;
}

void tell_heights(const std::filesystem::path& path, const io::PoseTable& table, double offset_m,
                  Console& console) {
  const auto is_elsewhere = [&](const io::PoseRow& row) {
    return std::abs(height_m(row) - offset_m) > kOtherLevel_m;
  };
  const auto elsewhere = std::ranges::count_if(table.rows, is_elsewhere);
  if (offset_m != 0.0)
    console.warn(
        fmt::format("{}: heights are counted from {:.2f} m, the poses' median, as robots find "
                    "themselves at height 0",
                    path.string(), offset_m));
  if (elsewhere > 0)
    console.warn(fmt::format(
        "{}: {} of {} poses are more than {:.1f} m above or below the median height: no robot will "
        "find itself there",
        path.string(), elsewhere, table.rows.size(), kOtherLevel_m));
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
  tell_heights(path, table_, offset_m_.z(), console);
  if (offset_m_.cwiseAbs().maxCoeff() > kFar_m) {
    console.warn(fmt::format(
        "{}: the poses lie {:.0f} km from the origin, as in UTM: an offset of "
        "({:.0f}, {:.0f}, {:.0f}) m is taken off",
        path.string(), offset_m_.norm() / 1000.0, offset_m_.x(), offset_m_.y(), offset_m_.z()));
  }
  for (io::PoseRow& row : table_.rows) row.pose.translation() -= offset_m_;
  check_reach(path, table_);
}

}  // namespace voxlist::desk
