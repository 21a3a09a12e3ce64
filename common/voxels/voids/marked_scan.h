#pragma once

#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/voxels/counters/ray_scratch.h"
#include "voxlist/voxels/numbering.h"
#include "voxlist/voxels/occupancy_map.h"
#include "voxlist/voxels/scan_hits.h"

namespace voxlist {

/// What a ray passes nearer than this (m) to its end may be what it hits: a wall that is met at a
/// grazing angle, the noise of ranges and poses.
inline constexpr double kVoidGap_m = 0.2;

/// The cells, of kPassedResolution_m for maps, that a scan's rays hit and pass. The rays are
/// followed once, for all who ask: how much of the scan is news, the map's passed cells, voids,
/// free space.
class MarkedScan {
 public:
  MarkedScan(double min_range_m, double max_range_m, double cell_m = kPassedResolution_m);

  double cell_m() const { return cell_m_; }

  /// Takes the cells of a scan (in base) in the place of those before; does nothing where it is the
  /// same scan at the same pose. Where the rays pass too many blocks (RayRules) all are followed
  /// only so far, and their last kVoidGap_m.
  void mark(const Pose3& T_map_base, const Cloud& cloud_base);

  struct Block {
    Voxel at;
    /// `early`: passed up to kVoidGap_m before a ray's end. `passed`: anywhere but in the cell that
    /// the ray itself ends in.
    BlockBits hit{}, early{}, passed{};
  };

  /// Blocks that were passed or hit, always in the same order.
  const std::vector<Block>& blocks() const { return blocks_; }

  /// Another one after each scan.
  std::uint64_t number() const { return number_; }

 private:
  bool is_same(const Pose3& T_map_base, const Cloud& cloud_base) const;
  void take_early(const Pose3& T_map_base, const Cloud& cloud_base);
  void mark_ends(const Pose3& T_map_base, const Cloud& cloud_base);
  Block& block_at(const Voxel& at);

  const double min_range_m_, max_range_m_, cell_m_;
  RayScratch scratch_;
  ScanHits ends_;  // what rays pass last
  Numbering<Voxel> positions_;
  std::vector<Block> blocks_;  // by number
  // The scan at hand.
  std::uint64_t number_ = 0;
  Pose3 T_map_base_ = Pose3::Identity();
  std::vector<Eigen::Vector3f> points_, origins_;
};

}  // namespace voxlist
