#include "voxlist/voxels/voids/carved_map.h"

#include <algorithm>
#include <cmath>

#include "voxlist/voxels/scan_rays.h"

namespace voxlist {
namespace {

// Edge of the cubes that are made again when a scan is taken out (m): a block of the coarsest
// cells, so that what belongs to a cube is whole blocks of every kind.
constexpr double kCube_m = 1.28;

// The cube that a block lies in, of cells of so many metres.
Voxel cube_of(const Voxel& block, double cell_m) {
  const auto in_cube = static_cast<std::int32_t>(std::lround(kCube_m / (kBlockEdge * cell_m)));
  return {floor_div(block.x, in_cube), floor_div(block.y, in_cube), floor_div(block.z, in_cube)};
}

bool is_in(const Numbering<Voxel>* cubes, const Voxel& block, double cell_m) {
  return !cubes || cubes->find(cube_of(block, cell_m)) != Numbering<Voxel>::kNone;
}

void add_to(VoxelBlock& block, const VoxelBlock& more) {
  for (std::size_t i = 0; i < block.size(); ++i) block[i] |= more[i];
}

VoxelBlock block_at(const VoxelMap& map, const Voxel& position) {
  const VoxelBlock* block = map.find_block(position);
  return block ? *block : VoxelBlock{};
}

void sort_once(std::vector<Voxel>& blocks) {
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
}

// Empties a map's blocks in these cubes.
void empty(const Numbering<Voxel>& cubes, VoxelMap& map, std::vector<Voxel>& changed) {
  for (std::size_t i = 0; i < map.block_count(); ++i) {
    const Voxel at = map.block_position(i);
    if (is_in(&cubes, at, map.resolution_m()) && map.set_block(at, {})) changed.push_back(at);
  }
}

void empty(const Numbering<Voxel>& cubes, CounterMap& counters) {
  std::vector<Voxel> inside;
  for (std::size_t i = 0; i < counters.block_count(); ++i)
    if (is_in(&cubes, counters.block_position(i), counters.resolution_m()))
      inside.push_back(counters.block_position(i));
  counters.forget(inside);
}

}  // namespace

CarvedMap::CarvedMap(const CarvingConfig& config)
    : config_(config), waiting_(map_.occupied.resolution_m()) {
  if (!config.carve) return;
  for (const VoidRule& rule : kVoidRules) {
    voids_.emplace_back(rule.cell_m, map_.occupied.resolution_m());
    scans_.emplace_back(rule, config.min_range_m, config.max_range_m);
  }
}

ChangedBlocks CarvedMap::add(const Scan& scan) {
  ChangedBlocks changed;
  changed.from = map_.revision();
  add(scan, nullptr, changed);
  sort_once(changed.occupied);
  sort_once(changed.passed);
  changed.to = map_.revision();
  return changed;
}

void CarvedMap::clear() {
  map_ = {};
  waiting_ = VoxelMap(map_.occupied.resolution_m());
  for (std::size_t i = 0; i < voids_.size(); ++i)
    voids_[i] = VoidCells(kVoidRules[i].cell_m, map_.occupied.resolution_m());
}

ChangedBlocks CarvedMap::recount(const std::vector<Scan>& touched,
                                 const std::function<std::optional<Scan>()>& all) {
  ChangedBlocks changed;
  changed.from = map_.revision();
  Cubes cubes;
  for (const Scan& scan : touched) list_cubes(scan, cubes);
  forget(cubes, changed);
  while (const std::optional<Scan> scan = all()) add(*scan, &cubes, changed);
  sort_once(changed.occupied);
  sort_once(changed.passed);
  changed.to = map_.revision();
  return changed;
}

std::size_t CarvedMap::count_doubted(const Scan& scan) {
  if (scans_.empty()) return 0;
  scans_.back().mark(scan.T_map_base, scan.cloud);
  std::size_t count = 0;
  for (const VoidScan::Block& seen : scans_.back().blocks())
    for (const std::uint64_t word : voids_.back().doubted(seen))
      count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

void CarvedMap::add(const Scan& scan, const Cubes* only, ChangedBlocks& changed) {
  touched_.clear();
  parts_.clear();
  mark_voids(scan);
  carve(only);
  walk_rays(scan, only, changed.passed);
  update_blocks(only, changed.occupied);
}

void CarvedMap::mark_voids(const Scan& scan) {
  for (VoidScan& voids : scans_) voids.mark(scan.T_map_base, scan.cloud);
}

void CarvedMap::carve(const Cubes* only) {
  for (std::size_t i = 0; i < voids_.size(); ++i) {
    for (const VoidScan::Block& seen : scans_[i].blocks()) {
      if (!is_in(only, seen.at, kVoidRules[i].cell_m)) continue;
      const VoidCells::Change change = voids_[i].count(seen);
      voids_[i].for_each_part(change.at, change.emptied, [&](const Voxel& at, const auto& voxels) {
        if (map_.occupied.find_block(at) || waiting_.find_block(at))
          add_to(part_at(at).lost, voxels);
      });
      voids_[i].for_each_part(change.at, change.turned,
                              [&](const Voxel& at, const auto&) { part_at(at); });
    }
  }
}

void CarvedMap::walk_rays(const Scan& scan, const Cubes* only, std::vector<Voxel>& changed) {
  const double resolution_m = map_.occupied.resolution_m();
  const double passed_m = map_.passed.resolution_m();
  ScanCells passed;
  const auto put_passed = [&] {
    passed.for_each_block([&](const Voxel& at, const VoxelBlock& bits) {
      if (is_in(only, at, passed_m) && map_.passed.merge_block(at, bits)) changed.push_back(at);
    });
    passed.clear();
  };
  visit_rays(scan.cloud, scan.T_map_base, config_.max_range_m, resolution_m,
             [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& point) {
               const Voxel v = voxel_at(point, resolution_m);
               part_at(block_of(v)).hit[static_cast<std::size_t>(v.z & 7)] |=
                   std::uint64_t{1} << ((v.x & 7) + 8 * (v.y & 7));
               mark_passed(origin, point, passed_m, passed);
               if (passed.memory_bytes() > kMaxScanBytes) put_passed();
             });
  put_passed();
}

void CarvedMap::update_blocks(const Cubes* only, std::vector<Voxel>& changed) {
  for (std::size_t i = 0; i < parts_.size(); ++i)
    if (is_in(only, touched_.key(i), map_.occupied.resolution_m()) &&
        update(touched_.key(i), parts_[i]))
      changed.push_back(touched_.key(i));
}

bool CarvedMap::update(const Voxel& block, const Part& part) {
  VoxelBlock there = block_at(map_.occupied, block), waiting = block_at(waiting_, block), in_void{};
  for (const VoidCells& cells : voids_) add_to(in_void, cells.void_voxels(block));
  for (std::size_t i = 0; i < there.size(); ++i) {
    const std::uint64_t all = ((there[i] | waiting[i]) & ~part.lost[i]) | part.hit[i];
    there[i] = all & ~in_void[i];
    waiting[i] = all & in_void[i];
  }
  if (waiting != VoxelBlock{} || waiting_.find_block(block)) waiting_.set_block(block, waiting);
  if (there == VoxelBlock{} && !map_.occupied.find_block(block)) return false;
  return map_.occupied.set_block(block, there);
}

CarvedMap::Part& CarvedMap::part_at(const Voxel& block) {
  const std::uint32_t number = touched_.number(block);
  if (number == parts_.size()) parts_.emplace_back();
  return parts_[number];
}

void CarvedMap::list_cubes(const Scan& scan, Cubes& cubes) {
  mark_voids(scan);
  for (std::size_t i = 0; i < scans_.size(); ++i)
    for (const VoidScan::Block& seen : scans_[i].blocks())
      cubes.number(cube_of(seen.at, kVoidRules[i].cell_m));
  const double passed_m = map_.passed.resolution_m(), voxel_m = map_.occupied.resolution_m();
  ScanCells passed;
  visit_rays(scan.cloud, scan.T_map_base, config_.max_range_m, voxel_m,
             [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& point) {
               cubes.number(cube_of(block_of(voxel_at(point, voxel_m)), voxel_m));
               mark_passed(origin, point, passed_m, passed);
             });
  passed.for_each_block(
      [&](const Voxel& at, const VoxelBlock&) { cubes.number(cube_of(at, passed_m)); });
}

void CarvedMap::forget(const Cubes& cubes, ChangedBlocks& changed) {
  std::vector<Voxel> waited;
  empty(cubes, map_.occupied, changed.occupied);
  empty(cubes, map_.passed, changed.passed);
  empty(cubes, waiting_, waited);
  for (VoidCells& cells : voids_) empty(cubes, cells.counters());
}

}  // namespace voxlist
