#include "voxlist/matching/surfaces/surfels.h"

#include <cmath>

#include "voxlist/matching/surfaces/surfel_fit.h"
#include "voxlist/system/check.h"

namespace voxlist::matching {
namespace {

// A larger cube speaks for smaller ones up to so many voxels: twice the fewest that make a surface,
// for each of the smaller cubes that a plane through it meets.
std::size_t most_voxels(std::size_t level, const SurfelConfig& config) {
  return static_cast<std::size_t>(2 * config.min_voxels) << (2 * level);
}

// The voxels of a cube of blocks, counted from its lowest.
std::vector<Voxel> voxels_of(const VoxelMap& map, const Voxel& first, std::int32_t blocks) {
  std::vector<Voxel> voxels;
  voxels.reserve(512);
  for (std::int32_t z = 0; z < blocks; ++z) {
    for (std::int32_t y = 0; y < blocks; ++y) {
      for (std::int32_t x = 0; x < blocks; ++x) {
        const VoxelBlock* block = map.find_block({first.x + x, first.y + y, first.z + z});
        if (block)
          VoxelMap::visit_block({x, y, z}, *block, [&](const Voxel& v) { voxels.push_back(v); });
      }
    }
  }
  return voxels;
}

}  // namespace

SurfelMap::SurfelMap(const OccupancyMap& map, const SurfelConfig& config)
    : map_(map), config_(config), revision_(map.revision()) {
  const double block_m = kBlockEdge * map.occupied.resolution_m();
  std::int32_t blocks =
      std::max(1, static_cast<std::int32_t>(std::lround(config.cell_m / block_m)));
  cubes_per_m_ = 1.0 / (blocks * block_m);
  for (Level& level : levels_) {
    level.blocks = blocks;
    blocks *= 2;
  }
}

void SurfelMap::map_changed() {
  for (Level& level : levels_)
    for (Cube& cube : level.cubes) cube.fitted = false;
  revision_ = map_.revision();
}

SurfelMap::Cube& SurfelMap::cube_at(std::size_t level, const Voxel& position) const {
  Level& l = levels_[level];
  const std::uint32_t number = l.positions.number(position);
  if (number == l.cubes.size()) l.cubes.emplace_back();
  Cube& cube = l.cubes[number];
  if (!cube.fitted) fit(level, position, cube);
  return cube;
}

void SurfelMap::fit(std::size_t level, const Voxel& position, Cube& cube) const {
  VOXLIST_CHECK(map_.revision() == revision_,
                "the map has changed and map_changed() was not called");
  const std::int32_t blocks = levels_[level].blocks;
  const Voxel first{position.x * blocks, position.y * blocks, position.z * blocks};
  const Voxel lowest{first.x * kBlockEdge, first.y * kBlockEdge, first.z * kBlockEdge};
  const std::vector<Voxel> voxels = voxels_of(map_.occupied, first, blocks);
  cube.fitted = true;
  cube.count = 0;
  cube.speaker = &cube;
  // Where smaller cubes have enough of their own, this one would join what does not belong
  // together.
  if (level > 0 && voxels.size() > most_voxels(level, config_)) return;
  const CubeShape shape = fit_surfels(map_, lowest, voxels, config_, cube.sides, cube.count);
  if (level > 0)
    for (Surfel& side : cube.sides) side.of_few_voxels = true;
  if (shape != CubeShape::kTooFew || level + 1 == levels_.size()) return;
  cube.speaker = cube_at(level + 1, {floor_div(position.x, 2), floor_div(position.y, 2),
                                     floor_div(position.z, 2)})
                     .speaker;
}

}  // namespace voxlist::matching
