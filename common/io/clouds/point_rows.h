#pragma once

#include <optional>
#include <string>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/io/clouds/raw_scan.h"

namespace voxlist::io {

/// Makes a cloud from a table whose columns have names: takes x, y, z and, where there, origin_x,
/// origin_y, origin_z (any letter case), leaves the other columns, and drops rows that are not
/// finite.
class PointRows {
 public:
  /// Throws FormatError when x, y or z is missing, or a wanted name comes twice. With `further` it
  /// takes all columns that have a name, and keeps rows that are not finite.
  PointRows(const std::vector<std::string>& names, FurtherColumns* further);

  /// Whether a name is that of one of the columns which are always taken.
  static bool is_point_column(const std::string& name);

  /// Whether a column is one of those taken.
  bool wants(std::size_t column) const { return slots_[column].has_value(); }

  /// Sets a wanted column of the row at hand.
  void set(std::size_t column, double value) { row_[*slots_[column]] = value; }

  /// The column's values are wider than a float: great ones are counted from the first.
  void count_from_first(std::size_t column) { is_wide_[column] = true; }

  /// The row at hand is complete.
  void finish_row();

  /// Announces how many rows will come.
  void reserve(std::size_t rows);

  Cloud take() { return std::move(cloud_); }

 private:
  void finish_further();

  std::vector<std::optional<std::size_t>> slots_;
  std::vector<bool> is_wide_;
  bool has_origins_ = false;
  std::vector<double> row_;  // x, y, z, the origin's, then the further ones
  std::vector<double> first_;
  Cloud cloud_;
  FurtherColumns* further_;
};

}  // namespace voxlist::io
