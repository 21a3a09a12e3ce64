#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "voxlist/matching/counting/coarse_sweep.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist::matching {

/// A map as rows of bits along x, for overlap_rows().
class RowMap {
 public:
  /// The voxels of a map within a box, `low` and `high` in it. A bit each: take the box as large as
  /// scans will be moved to, and no larger.
  RowMap(const VoxelMap& map, const Voxel& low, const Voxel& high);

  const Voxel& low() const { return low_; }
  const Voxel& high() const { return high_; }

  /// Number of the bit of a voxel of the box, and words from one row to the next along y.
  std::int64_t bit(const Voxel& v) const {
    return 64 * ((v.z - std::int64_t{low_.z}) * layer_words_ +
                 (v.y - std::int64_t{low_.y}) * row_words_) +
           (v.x - std::int64_t{low_.x});
  }
  std::int64_t row_words() const { return row_words_; }

  /// A bit from which on all are free, for a layer and more.
  std::int64_t free_bit() const { return 64 * (high_.z - std::int64_t{low_.z} + 1) * layer_words_; }

  const std::uint64_t* words() const { return words_.data(); }

 private:
  Voxel low_, high_;
  std::int64_t row_words_, layer_words_;
  std::vector<std::uint64_t> words_;
};

/// Translations in voxels: `columns` along x and `rows` along y, the first one first.
struct TranslationBlock {
  Voxel first;
  std::int32_t columns, rows;
};

/// The same integers as overlap() at each translation of the block: counts[row * columns + column].
/// A funnel-shifted row of the map tests one voxel of the scan at as many translations as a
/// register has bits, and adders in bit planes count; best with columns a multiple of 512. Throws
/// std::invalid_argument when a voxel leaves the map's box, for more than 65535 voxels, and for
/// counts of another size.
void overlap_rows(const RowMap& map, std::span<const Voxel> scan, const TranslationBlock& block,
                  Instructions instructions, std::span<std::uint16_t> counts);

}  // namespace voxlist::matching
