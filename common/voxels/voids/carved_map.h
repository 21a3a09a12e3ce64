#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "voxlist/voxels/occupancy_map.h"
#include "voxlist/voxels/scan_news.h"
#include "voxlist/voxels/voids/free_space.h"
#include "voxlist/voxels/voids/marked_scan.h"
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
  /// Whether free space is counted as well (FreeSpace): it takes about a byte a cell of 0.08 m.
  bool count_free = false;
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

  /// Hands out scans one by one, then nothing. What it has handed out is there until it is asked
  /// for the next.
  using Scans = std::function<std::optional<Scan>()>;

  /// Adds a scan. Points that are not within the ranges are left out, rays and all. What its voids
  /// took from the map is among what changed.
  ChangedBlocks add(const Scan& scan);

  /// Begins an empty map.
  void clear();

  /// Takes scans out, or moves them. `touched`: each of them where it was, and where it is now, if
  /// it is in. `all`: the scans that are in now, in their order. Only what the touched ones see is
  /// made again, from all scans that reach it; the map has then the same bits as one made anew.
  ChangedBlocks recount(const Scans& touched, const Scans& all);

  /// What adding a scan would tell.
  ScanNews news_of(const Scan& scan);

  /// Cells of the finer rule that hold something of the map, and that a scan sees to be void: what
  /// adding it may take away.
  std::size_t count_doubted(const Scan& scan);

  const OccupancyMap& map() const { return map_; }

  /// Calls visit(part) for each VoxelMap and CounterMap that all else here is made of, always in
  /// the same order.
  template <class Visit>
  void visit_parts(const Visit& visit) const {
    visit_parts_of(*this, visit);
  }

  /// Calls fill(part) for the same of an empty map. Then it is the one that was visited.
  template <class Fill>
  void restore(const Fill& fill) {
    visit_parts_of(*this, fill);
    free_.follow();
  }

  /// What was hit in void space and is not in the map, or not yet.
  const VoxelMap& waiting() const { return waiting_; }

  /// Where it is counted; empty otherwise.
  FreeSpace& free_space() { return free_; }
  const FreeSpace& free_space() const { return free_; }

 private:
  // What a scan does to a block of the map's voxels.
  struct Part {
    VoxelBlock lost{}, hit{};
  };
  // Large cubes by their position; where a pointer to them is nullptr, everywhere.
  using Cubes = Numbering<Voxel>;

  template <class Self, class Visit>
  static void visit_parts_of(Self& self, const Visit& visit) {
    visit(self.map_.occupied);
    visit(self.map_.passed);
    visit(self.waiting_);
    for (auto& cells : self.voids_) visit(cells.counters());
    if (self.config_.count_free) visit(self.free_.counters());
  }

  void add(const Scan& scan, const Cubes* only, ChangedBlocks& changed);
  void mark(const Scan& scan);
  void carve(const Cubes* only);
  void put_cells(const Cubes* only, std::vector<Voxel>& changed);
  void put_hits(const Scan& scan);
  void update_blocks(const Cubes* only, std::vector<Voxel>& changed);
  bool update(const Voxel& block, const Part& part);
  Part& part_at(const Voxel& block);
  template <class Visit>
  void visit_hits(const Scan& scan, const Visit& visit) const;
  void list_cubes(const Scan& scan, Cubes& cubes);
  void forget(const Cubes& cubes, ChangedBlocks& changed);

  CarvingConfig config_;
  OccupancyMap map_;
  VoxelMap waiting_;
  FreeSpace free_;
  MarkedScan marks_;              // of the scan at hand
  std::vector<VoidCells> voids_;  // of each rule
  std::vector<VoidScan> scans_;   // the scan at hand, by each rule
  // Blocks that it may change.
  Numbering<Voxel> touched_;
  std::vector<Part> parts_;
};

}  // namespace voxlist
