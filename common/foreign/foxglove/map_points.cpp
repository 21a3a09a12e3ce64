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
  const bus::AppliedChange applied = bus::apply(change, map_);
  return applied.replaced ? std::max<std::size_t>(blocks(), 1) : applied.changed.occupied.size();
}

Packed MapPoints::points() const {
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
