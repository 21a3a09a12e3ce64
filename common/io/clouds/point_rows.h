#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/geometry/cloud.h"

namespace voxlist::io {

/// Makes a cloud from a table whose columns have names: takes x, y, z and, where there, origin_x,
/// origin_y, origin_z (any letter case), leaves the other columns, and drops rows that are not
/// finite.
class PointRows {
 public:
  /// Throws FormatError when x, y or z is missing, or a wanted name comes twice.
  explicit PointRows(const std::vector<std::string>& names);

  /// Whether a column is one of those taken.
  bool wants(std::size_t column) const { return slots_[column].has_value(); }

  /// Sets a wanted column of the row at hand.
  void set(std::size_t column, double value) { row_[*slots_[column]] = value; }

  /// The row at hand is complete.
  void finish_row();

  /// Announces how many rows will come.
  void reserve(std::size_t rows);

  Cloud take() { return std::move(cloud_); }

 private:
  std::vector<std::optional<std::size_t>> slots_;
  bool has_origins_ = false;
  std::array<double, 6> row_{};
  Cloud cloud_;
};

}  // namespace voxlist::io
