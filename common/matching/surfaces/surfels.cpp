#include "voxlist/matching/surfaces/surfels.h"

#include <cmath>
#include <limits>

#include "voxlist/matching/surfaces/surfel_fit.h"
#include "voxlist/system/check.h"
#include "voxlist/voxels/fast_cell.h"

namespace voxlist::matching {

SurfelMap::SurfelMap(const OccupancyMap& map, const SurfelConfig& config)
    : map_(map), config_(config), revision_(map.revision()) {
  const double block_m = kBlockEdge * map.occupied.resolution_m();
  blocks_ = std::max(1, static_cast<std::int32_t>(std::lround(config.cell_m / block_m)));
  cubes_per_m_ = 1.0 / (blocks_ * block_m);
}

const Surfel* SurfelMap::find(const Eigen::Vector3d& point, const Eigen::Vector3d& origin,
                              LookUp& last) const {
  const Voxel position = cell_at(point, cubes_per_m_);
  if (!last.cube || position != last.position) last = {position, &cube_at(position)};
  const Cube& cube = *last.cube;
  const Surfel* nearest = nullptr;
  double least_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i < cube.count; ++i) {
    const Surfel& side = cube.sides[i];
    const double off_m = std::abs(side.normal.dot(point - side.mean));
    if (off_m >= least_m || !side.faces(origin, point)) continue;
    nearest = &side;
    least_m = off_m;
  }
  return nearest;
}

void SurfelMap::map_changed() {
  for (Cube& cube : cubes_) cube.fitted = false;
  revision_ = map_.revision();
}

SurfelMap::Cube& SurfelMap::cube_at(const Voxel& position) const {
  const std::uint32_t number = positions_.number(position);
  if (number == cubes_.size()) cubes_.emplace_back();
  Cube& cube = cubes_[number];
  if (!cube.fitted) fit(position, cube);
  return cube;
}

void SurfelMap::fit(const Voxel& position, Cube& cube) const {
  VOXLIST_CHECK(map_.revision() == revision_,
                "the map has changed and map_changed() was not called");
  const Voxel first{position.x * blocks_, position.y * blocks_, position.z * blocks_};
  const Voxel lowest{first.x * kBlockEdge, first.y * kBlockEdge, first.z * kBlockEdge};
  std::vector<Voxel> voxels;
  voxels.reserve(512);
  for (std::int32_t z = 0; z < blocks_; ++z) {
    for (std::int32_t y = 0; y < blocks_; ++y) {
      for (std::int32_t x = 0; x < blocks_; ++x) {
        const VoxelBlock* block = map_.occupied.find_block({first.x + x, first.y + y, first.z + z});
        if (block)
          VoxelMap::visit_block({x, y, z}, *block, [&](const Voxel& v) { voxels.push_back(v); });
      }
    }
  }
  cube.count = fit_surfels(map_, lowest, voxels, config_, cube.sides);
  cube.fitted = true;
}

}  // namespace voxlist::matching
