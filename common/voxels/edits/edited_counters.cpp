#include "voxlist/voxels/edits/edited_counters.h"

#include <numeric>

#include "voxlist/voxels/voids/free_neighbours.h"

namespace voxlist {
namespace {

// As they are stored (CounterBlock).
constexpr unsigned kUnknown = 0, kSurelyFree = 1;

unsigned surely_occupied(const CounterRule& rule) {
  return static_cast<unsigned>(rule.highest - rule.lowest + 1);
}

void set(const BlockBits& cells, unsigned value, CounterBlock& block) {
  for (std::size_t plane = 0; plane < block.planes.size(); ++plane) {
    const std::uint64_t bits = (value >> plane & 1) != 0 ? ~std::uint64_t{0} : 0;
    for (std::size_t w = 0; w < cells.size(); ++w) {
      std::uint64_t& word = block.planes[plane][w];
      word = (word & ~cells[w]) | (bits & cells[w]);
    }
  }
}

BlockBits both(BlockBits a, const BlockBits& b) {
  for (std::size_t w = 0; w < a.size(); ++w) a[w] &= b[w];
  return a;
}

}  // namespace

EditedCounters::EditedCounters(const CounterMap& map, const std::vector<PlacedBox>& boxes)
    : edits_(boxes, map.resolution_m()), edited_(map.resolution_m(), map.rule()) {
  for (const EditKind kind : {EditKind::kKeepFree, EditKind::kKeepBlocked})
    for (const Voxel& block : edits_.blocks_of(kind)) edit(block, {}, {});
  std::vector<std::uint32_t> all(map.block_count());
  std::iota(all.begin(), all.end(), 0u);
  update(map, all);
}

void EditedCounters::update(const CounterMap& map, std::span<const std::uint32_t> changed) {
  for (const std::uint32_t number : changed)
    edit(map.block_position(number), map.block(number), map.occupied(number));
}

void EditedCounters::edit(const Voxel& at, const CounterBlock& unedited,
                          const BlockBits& occupied) {
  const BlockEdits::Cells cells = edits_.cells_of(at);
  CounterBlock block = unedited;
  set(both(in_keys(cells.of(EditKind::kErase)), occupied), kUnknown, block);
  set(in_keys(cells.of(EditKind::kKeepFree)), kSurelyFree, block);
  set(in_keys(cells.of(EditKind::kKeepBlocked)), surely_occupied(edited_.rule()), block);
  edited_.counters_at(at) = block;
}

}  // namespace voxlist
