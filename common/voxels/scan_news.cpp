#include "voxlist/voxels/scan_news.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "voxlist/system/check.h"
#include "voxlist/voxels/scan_cells.h"
#include "voxlist/voxels/scan_rays.h"

namespace voxlist {
namespace {

double share_of(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

// Voxels along a cell's edge.
std::int32_t edge_of_cell(const OccupancyMap& map) {
  const auto edge = static_cast<std::int32_t>(
      std::lround(map.passed.resolution_m() / map.occupied.resolution_m()));
  VOXLIST_CHECK(edge > 0 && kBlockEdge % edge == 0, "cells must divide blocks of voxels");
  return edge;
}

// Whether one of a cell's voxels, which all lie in one block, is occupied.
bool has_hit(const Voxel& cell, std::int32_t edge, const VoxelMap& occupied) {
  const Voxel first{cell.x * edge, cell.y * edge, cell.z * edge};
  const VoxelBlock* block = occupied.find_block(block_of(first));
  if (!block) return false;
  std::uint64_t layer = 0;
  for (std::int32_t z = 0; z < edge; ++z)
    layer |= (*block)[static_cast<std::size_t>((first.z & 7) + z)];
  const std::uint64_t row = ((std::uint64_t{1} << edge) - 1) << (first.x & 7);
  std::uint64_t face = 0;
  for (std::int32_t y = 0; y < edge; ++y) face |= row << 8 * ((first.y & 7) + y);
  return (layer & face) != 0;
}

void count_passes(const Voxel& position, const VoxelBlock& bits, const VoxelMap& passed,
                  ScanNews& news) {
  const VoxelBlock* known = passed.find_block(position);
  for (std::size_t z = 0; z < bits.size(); ++z) {
    news.passed += static_cast<std::size_t>(std::popcount(bits[z]));
    news.newly_passed +=
        static_cast<std::size_t>(std::popcount(bits[z] & ~(known ? (*known)[z] : 0)));
  }
}

void count_hits(const Voxel& position, const VoxelBlock& bits, const OccupancyMap& map,
                ScanNews& news) {
  const std::int32_t edge = edge_of_cell(map);
  VoxelMap::visit_block(position, bits, [&](const Voxel& cell) {
    ++news.hit;
    if (!has_hit(cell, edge, map.occupied)) ++news.newly_hit;
  });
}

void count_passes(ScanCells& cells, const OccupancyMap& map, ScanNews& news) {
  cells.for_each_block([&](const Voxel& position, const VoxelBlock& bits) {
    count_passes(position, bits, map.passed, news);
  });
  cells.clear();
}

void count_hits(ScanCells& cells, const OccupancyMap& map, ScanNews& news) {
  cells.for_each_block([&](const Voxel& position, const VoxelBlock& bits) {
    count_hits(position, bits, map, news);
  });
  cells.clear();
}

}  // namespace

double ScanNews::share() const {
  return std::max(share_of(newly_hit, hit), share_of(newly_passed, passed));
}

void add_news(const Voxel& block, const VoxelBlock& hit, const VoxelBlock& passed,
              const OccupancyMap& map, ScanNews& news) {
  count_hits(block, hit, map, news);
  count_passes(block, passed, map.passed, news);
}

ScanNews scan_news(const Cloud& cloud_base, const Pose3& T_map_base, double max_range_m,
                   const OccupancyMap& map) {
  const double resolution_m = map.passed.resolution_m();
  ScanNews news;
  ScanCells hit, passed;
  visit_rays(cloud_base, T_map_base, max_range_m, map.occupied.resolution_m(),
             [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& point) {
               hit.mark(voxel_at(point, resolution_m));
               mark_passed(origin, point, resolution_m, passed);
               if (hit.memory_bytes() > kMaxScanBytes) count_hits(hit, map, news);
               if (passed.memory_bytes() > kMaxScanBytes) count_passes(passed, map, news);
             });
  count_hits(hit, map, news);
  count_passes(passed, map, news);
  return news;
}

}  // namespace voxlist
