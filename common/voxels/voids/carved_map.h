#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "voxlist/voxels/occupancy_map.h"
#include "voxlist/voxels/voids/void_cells.h"

namespace voxlist {

/// The rules by which space is void: a cell is where either says so. Chosen on the seeds that
/// tests/bench/README.md tells (bench_ghosts). Large cells see voids between the rays of scanners
/// with 5000 points, small ones come nearer to walls and floors.
inline constexpr std::array kVoidRules{VoidRule{0.16, 22}, VoidRule{0.08, 20}};

/// Whether what has gone leaves the map, and which points count.
struct CarvingConfig {
  bool carve = true;
  double min_range_m = 0.05;
  double max_range_m = 100.0;
};

/// A map without what has gone: people who walked through, furniture that was moved. A voxel that
/// was hit is in the map unless the space is void there (VoidCells); what is hit in void space
/// waits until hits outweigh voids. The order of scans matters: the same scans in the same order
/// give the same bits.
class CarvedMap {
 public:
  explicit CarvedMap(const CarvingConfig& config = {});

  /// A cloud (in base) and its pose.
  struct Scan {
    const Pose3& T_map_base;
    const Cloud& cloud;
  };

  /// Adds a scan. Points are left out as by add_scan(). What its voids took from the map is among
  /// what changed.
  ChangedBlocks add(const Scan& scan);

  /// Begins an empty map.
  void clear();

  /// Takes scans out, or moves them. `touched`: each of them where it was, and where it is now, if
  /// it is in. `all`: hands out the scans that are in now, in their order, then nothing. Only what
  /// the touched ones see is made again, from all scans; the map has then the same bits as one made
  /// anew.
  ChangedBlocks recount(const std::vector<Scan>& touched,
                        const std::function<std::optional<Scan>()>& all);

  /// Cells of the finer rule that hold something of the map, and that a scan sees to be void: what
  /// adding it may take away.
  std::size_t count_doubted(const Scan& scan);

  const OccupancyMap& map() const { return map_; }

  /// What was hit in void space and is not in the map, or not yet.
  const VoxelMap& waiting() const { return waiting_; }

 private:
  // What a scan does to a block of the map's voxels.
  struct Part {
    VoxelBlock lost{}, hit{};
  };
  // Large cubes by their position; where a pointer to them is nullptr, everywhere.
  using Cubes = Numbering<Voxel>;

  void add(const Scan& scan, const Cubes* only, ChangedBlocks& changed);
  void mark_voids(const Scan& scan);
  void carve(const Cubes* only);
  void walk_rays(const Scan& scan, const Cubes* only, std::vector<Voxel>& changed);
  void update_blocks(const Cubes* only, std::vector<Voxel>& changed);
  bool update(const Voxel& block, const Part& part);
  Part& part_at(const Voxel& block);
  void list_cubes(const Scan& scan, Cubes& cubes);
  void forget(const Cubes& cubes, ChangedBlocks& changed);

  CarvingConfig config_;
  OccupancyMap map_;
  VoxelMap waiting_;
  std::vector<VoidCells> voids_;  // of each rule
  std::vector<VoidScan> scans_;   // the scan at hand, by each rule
  // Blocks that it may change.
  Numbering<Voxel> touched_;
  std::vector<Part> parts_;
};

}  // namespace voxlist
