#include "voxlist/planning/grids/column_tile.h"

#include <algorithm>

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

std::uint64_t ColumnTile::differs_from(const ColumnTile& other) const {
  std::uint64_t columns = 0;
  for (std::size_t i = 0; i < kColumns; ++i)
    if (!std::ranges::equal(of(spans_, spans_end_, i), of(other.spans_, other.spans_end_, i)) ||
        !std::ranges::equal(of(free_, free_end_, i), of(other.free_, other.free_end_, i)))
      columns |= std::uint64_t{1} << i;
  return columns;
}

std::size_t ColumnTile::memory_bytes() const {
  return sizeof *this + spans_.capacity() * sizeof(Span) + free_.capacity() * sizeof(FreeRun);
}

}  // namespace voxlist::planning
