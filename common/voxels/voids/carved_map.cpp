#include "voxlist/voxels/voids/carved_map.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>

#include "voxlist/geometry/range.h"

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

// The box (m) of some cubes.
Eigen::AlignedBox3d box_of(const Numbering<Voxel>& cubes) {
  Eigen::AlignedBox3d box;
  for (const Voxel& at : cubes.keys()) {
    const Eigen::Vector3d low = kCube_m * Eigen::Vector3d(at.x, at.y, at.z);
    box.extend(low);
    box.extend(Eigen::Vector3d(low + Eigen::Vector3d::Constant(kCube_m)));
  }
  return box;
}

// Whether a scan's rays may get into a box: its farthest point, or start of a ray, is as far.
bool reaches(const CarvedMap::Scan& scan, const Eigen::AlignedBox3d& box) {
  float farthest2 = 0.0F;
  for (const auto& p : scan.cloud.points) farthest2 = std::max(farthest2, p.squaredNorm());
  for (const auto& p : scan.cloud.origins) farthest2 = std::max(farthest2, p.squaredNorm());
  // A cell is as much as rounding may be off.
  return !box.isEmpty() && box.exteriorDistance(Eigen::Vector3d(scan.T_map_base.translation())) <=
                               std::sqrt(double{farthest2}) + kPassedResolution_m;
}

}  // namespace

CarvedMap::CarvedMap(const CarvingConfig& config)
    : config_(config),
      waiting_(map_.occupied.resolution_m()),
      marks_(config.min_range_m, config.max_range_m) {
  if (!config.carve) return;
  for (const VoidRule& rule : kVoidRules) {
    voids_.emplace_back(rule.cell_m, map_.occupied.resolution_m());
    scans_.emplace_back(rule);
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
  free_ = {};
  for (std::size_t i = 0; i < voids_.size(); ++i)
    voids_[i] = VoidCells(kVoidRules[i].cell_m, map_.occupied.resolution_m());
}

ChangedBlocks CarvedMap::recount(const Scans& touched, const Scans& all) {
  ChangedBlocks changed;
  changed.from = map_.revision();
  Cubes cubes;
  while (const std::optional<Scan> scan = touched()) list_cubes(*scan, cubes);
  forget(cubes, changed);
  const Eigen::AlignedBox3d box = box_of(cubes);
  while (const std::optional<Scan> scan = all())
    if (reaches(*scan, box)) add(*scan, &cubes, changed);
  sort_once(changed.occupied);
  sort_once(changed.passed);
  changed.to = map_.revision();
  return changed;
}

ScanNews CarvedMap::news_of(const Scan& scan) {
  marks_.mark(scan.T_map_base, scan.cloud);
  ScanNews news;
  for (const MarkedScan::Block& block : marks_.blocks())
    add_news(block.at, in_rows(CellStore::Block(block.hit)),
             in_rows(CellStore::Block(block.passed)), map_, news);
  return news;
}

std::size_t CarvedMap::count_doubted(const Scan& scan) {
  if (scans_.empty()) return 0;
  marks_.mark(scan.T_map_base, scan.cloud);
  scans_.back().take(marks_);
  std::size_t count = 0;
  for (const VoidScan::Block& seen : scans_.back().blocks())
    for (const std::uint64_t word : voids_.back().doubted(seen))
      count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

void CarvedMap::add(const Scan& scan, const Cubes* only, ChangedBlocks& changed) {
  touched_.clear();
  parts_.clear();
  mark(scan);
  carve(only);
  put_cells(only, changed.passed);
  put_hits(scan);
  update_blocks(only, changed.occupied);
}

void CarvedMap::mark(const Scan& scan) {
  marks_.mark(scan.T_map_base, scan.cloud);
  for (VoidScan& voids : scans_) voids.take(marks_);
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

void CarvedMap::put_cells(const Cubes* only, std::vector<Voxel>& changed) {
  for (const MarkedScan::Block& block : marks_.blocks()) {
    if (!is_in(only, block.at, kPassedResolution_m)) continue;
    if (config_.count_free) free_.count(block);
    if (block.passed != BlockBits{} &&
        map_.passed.merge_block(block.at, in_rows(CellStore::Block(block.passed))))
      changed.push_back(block.at);
  }
}

// Calls visit(voxel) for each point that counts.
template <class Visit>
void CarvedMap::visit_hits(const Scan& scan, const Visit& visit) const {
  const double resolution_m = map_.occupied.resolution_m();
  for (std::size_t i = 0; i < scan.cloud.points.size(); ++i) {
    if (!is_within(scan.cloud, i, config_.min_range_m, config_.max_range_m)) continue;
    const Eigen::Vector3d point = scan.T_map_base * scan.cloud.points[i].cast<double>();
    const Eigen::Vector3d origin = scan.T_map_base * scan.cloud.origin(i).cast<double>();
    if (in_lattice(point, resolution_m) && in_lattice(origin, resolution_m))
      visit(voxel_at(point, resolution_m));
  }
}

void CarvedMap::put_hits(const Scan& scan) {
  visit_hits(scan, [&](const Voxel& v) {
    part_at(block_of(v)).hit[static_cast<std::size_t>(v.z & 7)] |= std::uint64_t{1}
                                                                   << ((v.x & 7) + 8 * (v.y & 7));
  });
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
  marks_.mark(scan.T_map_base, scan.cloud);
  for (const MarkedScan::Block& block : marks_.blocks())
    cubes.number(cube_of(block.at, kPassedResolution_m));
  const double voxel_m = map_.occupied.resolution_m();
  visit_hits(scan, [&](const Voxel& v) { cubes.number(cube_of(block_of(v), voxel_m)); });
}

void CarvedMap::forget(const Cubes& cubes, ChangedBlocks& changed) {
  std::vector<Voxel> waited;
  empty(cubes, map_.occupied, changed.occupied);
  empty(cubes, map_.passed, changed.passed);
  empty(cubes, waiting_, waited);
  for (VoidCells& cells : voids_) empty(cubes, cells.counters());
  empty(cubes, free_.counters());
}

}  // namespace voxlist
