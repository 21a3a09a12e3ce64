#include "services/voxlist/report/measured/chance.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numbers>

#include "services/voxlist/report/measured/places.h"
#include "voxlist/matching/paper/overlap.h"
#include "voxlist/simulation/random.h"
#include "voxlist/voxels/occupancy_list.h"

namespace voxlist::desk {
namespace {

constexpr double kWrong_m = 1.0;

struct Box {
  Voxel low{1 << 22, 1 << 22, 1 << 22}, high{-(1 << 22), -(1 << 22), -(1 << 22)};

  explicit Box(const VoxelMap& map) {
    map.for_each_voxel([&](const Voxel& v) {
      low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
      high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    });
  }

  std::int64_t voxels() const {
    return std::int64_t{high.x - low.x + 1} * (high.y - low.y + 1) * (high.z - low.z + 1);
  }
};

std::vector<Pose2> wrong_poses(const VoxelMap& map, const Pose2& truth, int count, int seed) {
  const Box box(map);
  const double edge_m = map.resolution_m();
  simulation::Random random(static_cast<std::uint64_t>(seed), 6);
  std::vector<Pose2> poses;
  while (std::ssize(poses) < count) {
    const double x = random.uniform(box.low.x * edge_m, (box.high.x + 1) * edge_m);
    const double y = random.uniform(box.low.y * edge_m, (box.high.y + 1) * edge_m);
    const Pose2 pose{x, y, random.uniform(-std::numbers::pi, std::numbers::pi)};
    if (distance_m(pose, truth) > kWrong_m) poses.push_back(pose);
  }
  return poses;
}

int overlap_at(const Cloud& scan, const Pose2& pose, const VoxelMap& map) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(scan.points.size());
  for (const Eigen::Vector3f& point : scan.points)
    points.push_back((pose * Eigen::Vector3d(point.cast<double>())).cast<float>());
  return matching::overlap(OccupancyList::from_points(points, map.resolution_m()).voxels(), map);
}

}  // namespace

std::vector<ChanceLevel> wrong_overlaps(const VoxelMap& finest, const PlacedScan& scan, int count,
                                        int seed) {
  const std::vector<Pose2> poses = wrong_poses(finest, scan.truth, count, seed);
  std::vector<ChanceLevel> levels;
  for (int factor = 1; factor <= 64; factor *= 2) {
    const VoxelMap map = coarser(finest, factor);
    const OccupancyList list = OccupancyList::from_points(scan.cloud.points, map.resolution_m());
    const std::int64_t volume = Box(map).voxels();
    ChanceLevel level{map.resolution_m(),
                      {volume, static_cast<std::int64_t>(map.size()),
                       std::min(volume, static_cast<std::int64_t>(list.size()))},
                      std::vector<double>(poses.size()),
                      overlap_at(scan.cloud, scan.truth, map)};
    tbb::parallel_for(std::size_t{0}, poses.size(), [&](std::size_t i) {
      level.overlaps[i] = overlap_at(scan.cloud, poses[i], map);
    });
    levels.push_back(std::move(level));
  }
  return levels;
}

PlacedScan band_of(const PlacedScan& scan, double low_m, double high_m) {
  PlacedScan band{{}, scan.truth};
  band.cloud.utime_us = scan.cloud.utime_us;
  for (std::size_t i = 0; i < scan.cloud.points.size(); ++i) {
    const Eigen::Vector3f& point = scan.cloud.points[i];
    if (point.z() < low_m || point.z() > high_m) continue;
    band.cloud.points.push_back(point);
    band.cloud.origins.push_back(scan.cloud.origin(i));
  }
  return band;
}

VoxelMap band_of(const VoxelMap& map, double low_m, double high_m) {
  VoxelMap band(map.resolution_m());
  map.for_each_voxel([&](const Voxel& voxel) {
    const double z = center(voxel, map.resolution_m()).z();
    if (z >= low_m && z <= high_m) band.insert(voxel);
  });
  return band;
}

}  // namespace voxlist::desk
