#include "voxlist/matching/surfaces/surfels.h"

#include <cmath>
#include <limits>

#include "voxlist/matching/surfaces/surfel_fit.h"
#include "voxlist/voxels/fast_cell.h"

namespace voxlist::matching {
namespace {

constexpr std::size_t kFirstDirectorySize = 1024;

// Cubes are at least a block: their coordinates fit 20 bits (kVoxelLimit / 8).
std::uint64_t pack(const Voxel& v) {
  const auto part = [](std::int32_t value) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(value + (1 << 20))) & 0x1fffff;
  };
  return part(v.x) | part(v.y) << 21 | part(v.z) << 42;
}

}  // namespace

SurfelMap::SurfelMap(const OccupancyMap& map, const SurfelConfig& config)
    : map_(map), config_(config), directory_(kFirstDirectorySize) {
  const double block_m = kBlockEdge * map.occupied.resolution_m();
  blocks_ = std::max(1, static_cast<std::int32_t>(std::lround(config.cell_m / block_m)));
  cubes_per_m_ = 1.0 / (blocks_ * block_m);
}

const Surfel* SurfelMap::find(const Eigen::Vector3d& point, const Eigen::Vector3d& origin,
                              Place& place) const {
  const Voxel position = cell_at(point, cubes_per_m_);
  if (!place.cube || position != place.position) place = {position, &cube_at(position)};
  const Cube& cube = *place.cube;
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
}

std::size_t SurfelMap::slot_of(std::uint64_t key) const {
  const std::size_t mask = directory_.size() - 1;
  const std::uint64_t hash = key * 0x9e3779b97f4a7c15u;
  std::size_t slot = (hash ^ (hash >> 32)) & mask;
  while (directory_[slot] != 0 && cubes_[directory_[slot] - 1].key != key) slot = (slot + 1) & mask;
  return slot;
}

SurfelMap::Cube& SurfelMap::cube_at(const Voxel& position) const {
  const std::uint64_t key = pack(position);
  std::size_t slot = slot_of(key);
  if (directory_[slot] == 0) {
    if (2 * (cubes_.size() + 1) > directory_.size()) {
      grow();
      slot = slot_of(key);
    }
    cubes_.emplace_back().key = key;
    directory_[slot] = static_cast<std::uint32_t>(cubes_.size());
  }
  Cube& cube = cubes_[directory_[slot] - 1];
  if (!cube.fitted) fit(position, cube);
  return cube;
}

void SurfelMap::grow() const {
  directory_.assign(2 * directory_.size(), 0);
  for (std::uint32_t i = 0; i < cubes_.size(); ++i) directory_[slot_of(cubes_[i].key)] = i + 1;
}

void SurfelMap::fit(const Voxel& position, Cube& cube) const {
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
