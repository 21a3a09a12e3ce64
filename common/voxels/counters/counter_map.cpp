#include "voxlist/voxels/counters/counter_map.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "voxlist/system/check.h"

namespace voxlist {

CounterMap::CounterMap(double resolution_m, const CounterRule& rule)
    : resolution_m_(resolution_m), rule_(rule), update_(rule) {
  if (!(resolution_m > 0.0))
    throw std::invalid_argument("CounterMap: resolution must be above 0 m");
}

void CounterMap::add(const RayScratch& scan, const Numbering<Voxel>* only) {
  VOXLIST_CHECK(scan.rules().resolution_m == resolution_m_, "a scan of another resolution");
  std::array<Update, kAtOnce> updates;
  std::size_t size = 0;
  scan.for_each_block([&](const Voxel& position, CellStore::Block passed, CellStore::Block hit) {
    if (only && only->find(position) == Numbering<Voxel>::kNone) return;
    const std::uint32_t number = number_at(position);
    updates[size++] = {number, fetched(at(number)), passed.data(), hit.data()};
    if (size == kAtOnce) count(std::span(updates.data(), std::exchange(size, 0)));
  });
  count(std::span(updates.data(), size));
}

// Asks for a block's memory before it is needed: blocks lie anywhere.
CounterBlock* CounterMap::fetched(CounterBlock& block) {
  for (const BlockBits& plane : block.planes) __builtin_prefetch(&plane, 1);
  return &block;
}

void CounterMap::count(std::span<const Update> updates) {
  for (const Update& u : updates)
    if (update_.count(CellStore::Block(u.passed, kWordsInBlock),
                      CellStore::Block(u.hit, kWordsInBlock), *u.block))
      note_change(u.number);
}

void CounterMap::forget(const std::vector<Voxel>& blocks) {
  for (const Voxel& position : blocks)
    if (positions_.find(position) != Numbering<Voxel>::kNone) counters_at(position) = {};
}

CellState CounterMap::at(const Voxel& cell) const {
  const std::uint32_t number = positions_.find(block_of(cell));
  if (number == Numbering<Voxel>::kNone) return CellState::kUnknown;
  const unsigned value = block(number).value(bit_in_block(cell));
  if (value == 0) return CellState::kUnknown;
  return static_cast<int>(value) - 1 + rule_.lowest >= 0 ? CellState::kOccupied : CellState::kFree;
}

int CounterMap::count_at(const Voxel& cell) const {
  const std::uint32_t number = positions_.find(block_of(cell));
  VOXLIST_CHECK(number != Numbering<Voxel>::kNone, "an unknown cell has no count");
  return static_cast<int>(block(number).value(bit_in_block(cell))) - 1 + rule_.lowest;
}

std::vector<std::uint32_t> CounterMap::take_changed() {
  for (const std::uint32_t number : changed_) is_changed_[number] = false;
  return std::exchange(changed_, {});
}

CounterBlock& CounterMap::counters_at(const Voxel& position) {
  const std::uint32_t number = number_at(position);
  note_change(number);
  return at(number);
}

void CounterMap::reserve(std::size_t blocks) {
  VOXLIST_CHECK(block_count() == 0, "room is made before the first block");
  positions_ = Numbering<Voxel>(blocks);
}

std::uint32_t CounterMap::number_at(const Voxel& position) {
  const std::uint32_t number = positions_.number(position);
  if (number == chunks_.size() * kChunk)
    chunks_.push_back(std::make_unique<CounterBlock[]>(kChunk));
  if (number == is_changed_.size()) is_changed_.push_back(false);
  return number;
}

void CounterMap::note_change(std::uint32_t number) {
  if (!is_changed_[number]) changed_.push_back(number);
  is_changed_[number] = true;
}

std::uint64_t CounterMap::hash() const {
  std::vector<std::uint32_t> order(block_count());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return block_position(a) < block_position(b);
  });
  std::uint64_t hash = 0;
  for (const std::uint32_t i : order) {
    if (block(i) == CounterBlock{}) continue;
    hash = mixed(hash ^ key_of(block_position(i)));
    for (const BlockBits& plane : block(i).planes)
      for (const std::uint64_t word : plane) hash = mixed(hash ^ word);
  }
  return hash;
}

std::size_t CounterMap::memory_bytes() const {
  return chunks_.size() * kChunk * sizeof(CounterBlock) + positions_.memory_bytes() +
         is_changed_.capacity() / 8 + changed_.capacity() * sizeof(std::uint32_t);
}

}  // namespace voxlist
