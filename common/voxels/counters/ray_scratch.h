#pragma once

#include <array>
#include <functional>
#include <limits>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/system/instructions.h"
#include "voxlist/voxels/counters/cell_store.h"
#include "voxlist/voxels/counters/mark_rays.h"
#include "voxlist/voxels/counters/ray_box.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist {

/// Which rays count, and what they may cost.
struct RayRules {
  double resolution_m = 0.1;
  double min_range_m = 0.05;
  double max_range_m = 100.0;
  /// Blocks of 8 x 8 x 8 cells that one scan's rays may pass; where they pass more, all are
  /// followed only so far. Half a million take 36 MB here and 150 MB in a map of counters; beside
  /// them the blocks of the largest box take 270 MB, where it is met everywhere.
  std::size_t most_blocks = std::size_t{1} << 19;
  /// False: of rays that start in one cell and end in one cell the first one stands for all, where
  /// all rays of the scan start in one cell.
  bool every_ray = true;
  /// So much of each ray before its end (m) is not followed.
  double end_gap_m = 0.0;
};

/// The cells that one scan's rays pass and hit, each once: exactly those of Amanatides and Woo
/// (Slabs says how ends and ties are told). Cells are the same for all instructions. Its memory is
/// kept from scan to scan.
class RayScratch {
 public:
  using Stopped = std::function<bool()>;

  explicit RayScratch(const RayRules& rules, Instructions instructions = best_instructions());

  /// Takes the cells of a scan (in base) in the place of those before. Every ray from where it
  /// started; those with an end outside of kReach are left out. Asks `stopped`, where given, every
  /// few hundred rays; once it says yes the answer is false, and the cells mean nothing.
  bool mark(const Pose3& T_map_base, const Cloud& cloud_base, const Stopped& stopped = {});

  /// Calls visit(block position, passed, hit) for each block with cells, always in the same order:
  /// eight words each, in the order of keys. A cell that is hit may be passed as well. What is
  /// handed out is there until the next mark().
  template <class Visit>
  void for_each_block(const Visit& visit) const {
    static constexpr BlockBits kNone{};
    const CellStore::Block none(kNone);
    for (std::uint32_t i = kFirstPlace; i < passed_.end(); ++i) {
      const std::uint32_t hit = hit_.find(passed_.block(i));
      visit(box_.block(passed_.block(i)), passed_.words(i), hit == 0 ? none : hit_.words(hit));
    }
    for (std::uint32_t i = kFirstPlace; i < hit_.end(); ++i)
      if (passed_.find(hit_.block(i)) == 0) visit(box_.block(hit_.block(i)), none, hit_.words(i));
    for (const FarHits& far : far_hits_) visit(far.block, none, CellStore::Block(far.hit));
  }

  /// How far (m) rays were followed at least, where they pass too many blocks or leave the box
  /// about the scan; infinite when all were followed to their ends.
  double reach_m() const { return reach_m_; }

  const RayRules& rules() const { return rules_; }

  /// Bytes that the scan takes.
  std::size_t used_bytes() const;

 private:
  // A block outside of the box.
  struct FarHits {
    Voxel block;
    BlockBits hit;
  };

  void collect(const Pose3& T_map_base, const Cloud& cloud_base);
  std::vector<FixedRay> cut_to_box();
  void keep_far_hits(std::vector<Voxel> cells);
  bool starts_in_one_cell() const;
  void mark_hits();
  bool follow(const Stopped& stopped);
  bool follow_as_far_as_fits(double longest, const Stopped& stopped);
  bool follow_to(double length, const Stopped& stopped);

  const RayRules rules_;
  const Instructions instructions_;
  RayBox box_;
  std::vector<FixedRay> rays_;  // in the box
  CellStore passed_, hit_;
  std::vector<FarHits> far_hits_;
  double reach_m_ = std::numeric_limits<double>::infinity();
};

}  // namespace voxlist
