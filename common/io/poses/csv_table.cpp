#include "voxlist/io/poses/csv_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "voxlist/io/files/cursor.h"
#include "voxlist/io/files/file_kind.h"

namespace voxlist::io {
namespace {

std::string_view trim(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r";
  text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
  return text.substr(0, text.find_last_not_of(kSpace) + 1);
}

std::string plain_name(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c))) {
      plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!plain.empty() && plain.back() != '_') {
      plain += '_';
    }
  }
  if (plain.ends_with('_')) {
    plain.pop_back();
  }
  return plain;
}

char separator_of(std::string_view header) {
  for (const char separator : {',', ';', '\t'}) {
    if (header.find(separator) != std::string_view::npos) {
      return separator;
    }
  }
  return ',';
}

std::vector<std::string> split(std::string_view line, char separator) {
  std::vector<std::string> cells;
  std::string cell;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == separator && !quoted) {
      cells.emplace_back(trim(cell));
      cell.clear();
    } else {
      cell += c;
    }
  }
  cells.emplace_back(trim(cell));
  return cells;
}

}  // namespace

CsvTable::CsvTable(const std::filesystem::path& path) : path_(path) {
  const std::string text = read_text(path);
  std::string_view rest = text;
  char separator = ',';
  for (std::size_t line_number = 1; !rest.empty(); ++line_number) {
    const std::string_view line = trim(take_line(rest));
    if (line.empty()) {
      continue;
    }
    if (names_.empty()) {
      separator = separator_of(line);
      decimal_commas_ = separator != ',';
      for (const std::string& name : split(line, separator)) {
        names_.push_back(plain_name(name));
      }
    } else if (!line.starts_with('#')) {
      rows_.push_back({line_number, split(line, separator)});
      check_length(rows_.size() - 1);
    }
  }
  if (names_.empty()) {
    throw FileError(path, "is empty, the first line must name the columns");
  }
}

std::optional<std::size_t> CsvTable::column(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names) {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found != names_.end()) {
      return static_cast<std::size_t>(found - names_.begin());
    }
  }
  return std::nullopt;
}

std::string CsvTable::column_names() const {
  std::string all;
  for (const std::string& name : names_) {
    all += (all.empty() ? "" : ", ") + name;
  }
  return all;
}

const std::string& CsvTable::text(std::size_t row, std::size_t column) const {
  static const std::string kEmpty;
  const auto& cells = rows_[row].cells;
  return column < cells.size() ? cells[column] : kEmpty;
}

std::string CsvTable::number_text(std::size_t row, std::size_t column) const {
  std::string number = text(row, column);
  if (decimal_commas_ && std::ranges::count(number, ',') == 1 &&
      number.find('.') == std::string::npos)
    std::ranges::replace(number, ',', '.');
  return number;
}

double CsvTable::number(std::size_t row, std::size_t column) const {
  double value = 0.0;
  try {
    value = parse_number(number_text(row, column));
  } catch (const FormatError& problem) {
    throw error(row, column, problem.what());
  }
  if (!std::isfinite(value)) {
    throw error(row, column, "the number must be finite");
  }
  return value;
}

bool CsvTable::is_not_finite(std::size_t row, std::size_t column) const {
  try {
    return !std::isfinite(parse_number(number_text(row, column)));
  } catch (const FormatError&) {
    return false;
  }
}

// Empty cells at the end hold nothing.
void CsvTable::check_length(std::size_t row) const {
  std::size_t cells = rows_[row].cells.size();
  while (cells > names_.size() && rows_[row].cells[cells - 1].empty()) --cells;
  if (cells > names_.size())
    throw error(row, fmt::format("{} cells instead of {}", cells, names_.size()));
}

FileError CsvTable::error(std::size_t row, const std::string& problem) const {
  return {path_, fmt::format("line {}: {}", rows_[row].line, problem)};
}

FileError CsvTable::error(std::size_t row, std::size_t column, const std::string& problem) const {
  return error(row, fmt::format("column {}: {}", names_[column], problem));
}

}  // namespace voxlist::io
