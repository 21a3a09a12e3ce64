#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "voxlist/planning/grids/floor_columns.h"

namespace voxlist::planning {

/// The part of a box that lies in another one; without cells where none does.
inline CellBox common_part(const CellBox& a, const CellBox& b) {
  CellBox part{{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)},
               {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)}};
  part.high = {std::max(part.low.x, part.high.x), std::max(part.low.y, part.high.y)};
  return part;
}

/// A box with so many cells more on each side.
inline CellBox grown(const CellBox& box, std::int32_t cells) {
  return {{box.low.x - cells, box.low.y - cells}, {box.high.x + cells, box.high.y + cells}};
}

/// Takes a cell into a box; an empty optional is a box without cells.
inline void take_in(std::optional<CellBox>& box, const Cell& cell) {
  if (!box) box = {cell, {cell.x + 1, cell.y + 1}};
  box->low = {std::min(box->low.x, cell.x), std::min(box->low.y, cell.y)};
  box->high = {std::max(box->high.x, cell.x + 1), std::max(box->high.y, cell.y + 1)};
}

/// Copies what two boxes have in common from the cells of one, row by row, to those of another.
template <class T>
void copy_cells(const CellBox& from_box, const std::vector<T>& from, const CellBox& to_box,
                std::vector<T>& to) {
  const CellBox part = common_part(from_box, to_box);
  for (std::int32_t y = part.low.y; y < part.high.y; ++y)
    std::copy_n(&from[from_box.index({part.low.x, y})], part.width(),
                &to[to_box.index({part.low.x, y})]);
}

/// The cells of a box that has become another one; new ones get `fill`.
template <class T>
std::vector<T> relaid(const CellBox& from_box, const std::vector<T>& from, const CellBox& to_box,
                      const T& fill) {
  std::vector<T> to(to_box.size(), fill);
  if (from_box.size() > 0) copy_cells(from_box, from, to_box, to);
  return to;
}

}  // namespace voxlist::planning
