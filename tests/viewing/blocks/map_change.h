#pragma once

#include <vector>

#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::viewing {

/// A whole map of these voxels of 0.05 m.
inline bus::MapChange whole_map(const std::vector<Voxel>& voxels, std::int64_t map_id = 1) {
  OccupancyMap map{VoxelMap(0.05), VoxelMap(0.1)};
  for (const Voxel& v : voxels) map.occupied.insert(v);
  bus::MapChange change;
  change.utime_us = 5'000'000;
  change.map_id = map_id;
  change.version = 1;
  change.resolution = bus::resolution_of(map);
  change.blocks = bus::to_messages(map);
  return change;
}

/// The blocks of these voxels, in place of what was there.
inline bus::MapChange changed_map(const std::vector<Voxel>& voxels, std::int64_t version) {
  bus::MapChange change = whole_map(voxels);
  change.base_version = version - 1;
  change.version = version;
  change.utime_us += 1'000'000 * version;
  return change;
}

}  // namespace voxlist::viewing
