#pragma once

#include <memory>
#include <span>
#include <vector>

#include "voxlist/voxels/counters/counter_block.h"
#include "voxlist/voxels/counters/ray_scratch.h"
#include "voxlist/voxels/numbering.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist {

/// What is known of a cell.
enum class CellState { kUnknown, kFree, kOccupied };

/// The map as planners want it: each cell unknown, free or occupied, by a counter of what passed
/// and hit it, four bits a cell of every block of 8 x 8 x 8 that a ray met (0.55 to 0.59 bytes with
/// the numbering of blocks). Scans count one after the other, each cell once a scan, as in
/// OctoMap's insertPointCloud; because counters stop at both ends of their range, the order of
/// scans matters. Reading from several threads at once is safe; writing is not.
class CounterMap {
 public:
  explicit CounterMap(double resolution_m, const CounterRule& rule = {});

  /// Counts a scan; where blocks are given, only in those. Precondition: the same resolution.
  void add(const RayScratch& scan, const Numbering<Voxel>* only = nullptr);

  /// Counts one pass or one hit for cells of one block.
  void add(const Voxel& position, CellStore::Block passed, CellStore::Block hit) {
    const std::uint32_t number = number_at(position);
    if (update_.count(passed, hit, at(number))) note_change(number);
  }

  /// The counters of a block, to be changed.
  CounterBlock& counters_at(const Voxel& position);

  /// Sets the blocks at these positions back to what they were before any scan. Counters cannot be
  /// subtracted: they stop at both ends of their range. So a scan is taken out, or moved, by
  /// forgetting the blocks that it touches, and counting all scans in their order again in these.
  void forget(const std::vector<Voxel>& blocks);

  CellState at(const Voxel& cell) const;

  /// The count of a cell: 0 or more means occupied. Precondition: it is not unknown.
  int count_at(const Voxel& cell) const;

  double resolution_m() const { return resolution_m_; }
  const CounterRule& rule() const { return rule_; }

  /// Number of blocks; block i lies at block_position(i). In order of insertion.
  std::size_t block_count() const { return positions_.size(); }
  const Voxel& block_position(std::size_t i) const { return positions_.key(i); }
  const CounterBlock& block(std::size_t i) const { return chunks_[i / kChunk][i % kChunk]; }
  BlockBits known(std::size_t i) const { return block(i).known(); }
  BlockBits occupied(std::size_t i) const { return update_.occupied(block(i)); }

  /// An empty map makes room for so many blocks.
  void reserve(std::size_t blocks);

  /// The block's number, or Numbering<Voxel>::kNone.
  std::uint32_t find_block(const Voxel& position) const { return positions_.find(position); }

  /// Numbers of the blocks with counters that changed since the last call, each once.
  std::vector<std::uint32_t> take_changed();

  /// A number that depends on what is known of each cell alone, not on the order of blocks.
  std::uint64_t hash() const;

  std::size_t memory_bytes() const;

 private:
  // Blocks are made so many at a time: growing moves nothing, and leaves little unused.
  static constexpr std::size_t kChunk = 64;

  // Blocks that are found before the first of them is changed.
  static constexpr std::size_t kAtOnce = 32;

  struct Update {
    std::uint32_t number = 0;
    CounterBlock* block = nullptr;
    const std::uint64_t *passed = nullptr, *hit = nullptr;
  };

  static CounterBlock* fetched(CounterBlock& block);
  void count(std::span<const Update> updates);
  std::uint32_t number_at(const Voxel& position);
  CounterBlock& at(std::uint32_t number) { return chunks_[number / kChunk][number % kChunk]; }
  void note_change(std::uint32_t number);

  double resolution_m_;
  CounterRule rule_;
  CounterUpdate update_;
  Numbering<Voxel> positions_;
  std::vector<std::unique_ptr<CounterBlock[]>> chunks_;
  std::vector<bool> is_changed_;
  std::vector<std::uint32_t> changed_;
};

}  // namespace voxlist
