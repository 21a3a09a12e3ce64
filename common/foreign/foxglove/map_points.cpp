#include "voxlist/foreign/foxglove/map_points.h"

#include <algorithm>

#include "voxlist/bus/maps/map_convert.h"
#include "voxlist/foreign/foxglove/scene_messages.h"
#include "voxlist/voxels/halved.h"

namespace voxlist::foreign {
namespace {

Packed points_of(const VoxelMap& map) {
  Packed points{point_fields(), {}};
  points.data.reserve(map.size() * stride_of(points.fields));
  map.for_each_voxel([&](const Voxel& voxel) { pack(center(voxel, map.resolution_m()), points); });
  return points;
}

}  // namespace

std::size_t MapPoints::apply(const bus::MapChange& change) {
  utime_us_ = change.utime_us;
  map_id_ = change.map_id;
  keyframes_.clear();
  const bus::AppliedChange applied = bus::apply(change, map_);
  return applied.replaced ? std::max<std::size_t>(blocks(), 1) : applied.changed.occupied.size();
}

std::size_t MapPoints::add(const bus::PosedCloud& keyframe) {
  if (map_id_ != 0) return 0;
  if (!keyframes_.empty() && keyframe.map_id != keyframes_.begin()->second.map_id)
    keyframes_.clear();
  utime_us_ = std::max(utime_us_, keyframe.cloud.utime_us);
  keyframes_[keyframe.index] = keyframe;
  return kBlocks;
}

VoxelMap MapPoints::map_of_keyframes() const {
  VoxelMap map(detail_m_);
  for (const auto& [index, keyframe] : keyframes_)
    for (const Eigen::Vector3f& point : keyframe.cloud.points) {
      const Eigen::Vector3d at = keyframe.T_map_base * point.cast<double>();
      if (in_lattice(at, detail_m_)) map.insert(voxel_at(at, detail_m_));
    }
  return map;
}

Packed MapPoints::points() const {
  if (!keyframes_.empty()) return points_of(map_of_keyframes());
  return 2.0 * map_.occupied.resolution_m() > detail_m_ ? points_of(map_.occupied)
                                                        : points_of(coarser(map_.occupied));
}

// The largest voxels that are made of the map's by doubling, and no larger than wanted.
VoxelMap MapPoints::coarser(const VoxelMap& map) const {
  VoxelMap level = halved(map);
  while (2.0 * level.resolution_m() <= detail_m_) level = halved(level);
  return level;
}

}  // namespace voxlist::foreign
