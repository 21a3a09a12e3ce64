#include "voxlist/planning/grids/column_tile.h"

namespace voxlist::planning {

void ColumnTile::add(const std::vector<Span>& spans, const std::vector<FreeRun>& free) {
  spans_.insert(spans_.end(), spans.begin(), spans.end());
  free_.insert(free_.end(), free.begin(), free.end());
  spans_end_[columns_] = static_cast<std::uint32_t>(spans_.size());
  free_end_[columns_] = static_cast<std::uint32_t>(free_.size());
  if (++columns_ < kColumns) return;
  spans_.shrink_to_fit();
  free_.shrink_to_fit();
}

std::span<Span> ColumnTile::spans_at(std::int32_t x, std::int32_t y) {
  const auto found = of(spans_, spans_end_, static_cast<std::size_t>(x + kTileEdge * y));
  return {spans_.data() + (found.data() - spans_.data()), found.size()};
}

std::size_t ColumnTile::memory_bytes() const {
  return sizeof *this + spans_.capacity() * sizeof(Span) + free_.capacity() * sizeof(FreeRun);
}

}  // namespace voxlist::planning
