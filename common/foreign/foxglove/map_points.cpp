#include "voxlist/foreign/foxglove/map_points.h"

#include <algorithm>

#include "voxlist/bus/maps/map_convert.h"
#include "voxlist/foreign/foxglove/scene_messages.h"

namespace voxlist::foreign {

std::size_t MapPoints::apply(const bus::MapChange& change) {
  utime_us_ = change.utime_us;
  map_id_ = change.map_id;
  const bus::AppliedChange applied = bus::apply(change, map_);
  return applied.replaced ? std::max<std::size_t>(blocks(), 1) : applied.changed.occupied.size();
}

Packed MapPoints::points() const {
  const double own_m = map_.occupied.resolution_m(), edge_m = std::max(own_m, detail_m_);
  VoxelMap level(edge_m);
  map_.occupied.for_each_voxel(
      [&](const Voxel& voxel) { level.insert(voxel_at(center(voxel, own_m), edge_m)); });
  Packed points{point_fields(), {}};
  points.data.reserve(level.size() * stride_of(points.fields));
  level.for_each_voxel([&](const Voxel& voxel) { pack(center(voxel, edge_m), points); });
  return points;
}

}  // namespace voxlist::foreign
