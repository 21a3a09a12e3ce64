#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxlist/io/files/file.h"

namespace voxlist::io {

/// A table with a header line, separated by commas, semicolons or tabs (whichever the header has).
///
/// Where commas separate nothing they may be decimal ones (0,5). Tolerates a byte order mark, CRLF,
/// quoted cells, blank lines, and # before comments and before the header. Column names are
/// compared in a plain form: lower case, runs of other signs than letters and digits as one
/// underscore ("X [m]" is "x_m"). What is wrong with a cell is told with its line and column.
class CsvTable {
 public:
  /// Throws FileError when the file cannot be read, has no header, or has a row with more cells
  /// than the header.
  explicit CsvTable(const std::filesystem::path& path);

  std::size_t rows() const { return rows_.size(); }

  /// The first column that has one of these (plain) names.
  std::optional<std::size_t> column(std::initializer_list<std::string_view> names) const;

  /// The plain names of all columns, for messages.
  std::string column_names() const;

  /// A cell's text, without quotes and outer spaces; empty when the row is too short.
  const std::string& text(std::size_t row, std::size_t column) const;

  /// A cell's number. Throws FileError when it is none or not finite.
  double number(std::size_t row, std::size_t column) const;

  /// Whether a cell holds nan or inf.
  bool is_not_finite(std::size_t row, std::size_t column) const;

  /// The error to throw for a row, or for a cell of it.
  FileError error(std::size_t row, const std::string& problem) const;
  FileError error(std::size_t row, std::size_t column, const std::string& problem) const;

 private:
  struct Row {
    std::size_t line;
    std::vector<std::string> cells;
  };

  std::string number_text(std::size_t row, std::size_t column) const;
  void check_length(std::size_t row) const;

  std::filesystem::path path_;
  std::vector<std::string> names_;
  bool decimal_commas_ = false;
  std::vector<Row> rows_;
};

}  // namespace voxlist::io
