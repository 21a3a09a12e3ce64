#include "voxlist/matching/surfaces/surfels.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "voxlist/matching/surfaces/surfel_fit.h"
#include "voxlist/system/check.h"

namespace voxlist::matching {
namespace {

// A larger cube speaks for smaller ones up to so many voxels: twice the fewest that make a surface,
// for each of the smaller cubes that a plane through it meets.
std::size_t most_voxels(std::size_t level, const SurfelConfig& config) {
  return static_cast<std::size_t>(2 * config.min_voxels) << (2 * level);
}

Voxel divided(const Voxel& v, std::int32_t by) {
  return {floor_div(v.x, by), floor_div(v.y, by), floor_div(v.z, by)};
}

Voxel difference(const Voxel& a, const Voxel& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

bool is_below(const Voxel& v, std::int32_t edge) {
  return std::min({v.x, v.y, v.z}) >= 0 && std::max({v.x, v.y, v.z}) < edge;
}

bool comes_before(const Voxel& a, const Voxel& b) {
  return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
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

// The voxels of a cube, counted from its lowest, block by block.
std::vector<Voxel> SurfelMap::voxels_of(std::size_t level, const Voxel& position) const {
  std::vector<Voxel> voxels;
  voxels.reserve(512);
  const auto take = [&](const Voxel& at, const VoxelBlock& bits) {
    VoxelMap::visit_block(at, bits, [&](const Voxel& v) { voxels.push_back(v); });
  };
  level == 0 ? visit_small(position, take) : visit_large(level, position, take);
  return voxels;
}

// Calls visit(block, counted from the cube's first, its voxels).
template <class Visit>
void SurfelMap::visit_small(const Voxel& position, const Visit& visit) const {
  const std::int32_t edge = levels_.front().blocks;
  for (std::int32_t z = 0; z < edge; ++z)
    for (std::int32_t y = 0; y < edge; ++y)
      for (std::int32_t x = 0; x < edge; ++x)
        if (const VoxelBlock* block = map_.occupied.find_block(
                {position.x * edge + x, position.y * edge + y, position.z * edge + z}))
          visit(Voxel{x, y, z}, *block);
}

// The same in the same order, for cubes that are mostly empty.
template <class Visit>
void SurfelMap::visit_large(std::size_t level, const Voxel& position, const Visit& visit) const {
  const std::int32_t edge = levels_[level].blocks;
  const Voxel first{position.x * edge, position.y * edge, position.z * edge};
  list_new_blocks();
  const std::uint32_t large = large_cubes_.find(divided(first, levels_.back().blocks));
  if (large == Numbering<Voxel>::kNone) return;
  for (const std::uint32_t number : blocks_in_[large]) {
    const Voxel at = difference(map_.occupied.block_position(number), first);
    if (is_below(at, edge)) visit(at, map_.occupied.block(number));
  }
}

// A map numbers its blocks as they come.
void SurfelMap::list_new_blocks() const {
  const VoxelMap& map = map_.occupied;
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return comes_before(map.block_position(a), map.block_position(b));
  };
  for (; listed_ < map.block_count(); ++listed_) {
    const auto number = static_cast<std::uint32_t>(listed_);
    const std::uint32_t large =
        large_cubes_.number(divided(map.block_position(number), levels_.back().blocks));
    if (large == blocks_in_.size()) blocks_in_.emplace_back();
    std::vector<std::uint32_t>& blocks = blocks_in_[large];
    blocks.insert(std::upper_bound(blocks.begin(), blocks.end(), number, before), number);
  }
}

void SurfelMap::fit(std::size_t level, const Voxel& position, Cube& cube) const {
  VOXLIST_CHECK(map_.revision() == revision_,
                "the map has changed and map_changed() was not called");
  const std::int32_t blocks = levels_[level].blocks;
  const std::int32_t edge = blocks * kBlockEdge;
  const Voxel lowest{position.x * edge, position.y * edge, position.z * edge};
  const std::vector<Voxel> voxels = voxels_of(level, position);
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
