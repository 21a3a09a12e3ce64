#include "voxlist/io/scans/row_match.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <map>
#include <set>

namespace voxlist::io {
namespace {

using Files = std::vector<std::filesystem::path>;
using Numbers = std::vector<std::int64_t>;
using Rows = std::vector<std::optional<std::size_t>>;

// How far a row's time may be from its scan's (us): what rounding to hundredths of a second costs.
constexpr std::int64_t kSameTime_us = 10'000;

// Entries of a long list that are told.
constexpr std::size_t kTold = 5;

std::size_t count(const Rows& rows) {
  const auto is_there = [](const auto& row) { return row.has_value(); };
  return static_cast<std::size_t>(std::ranges::count_if(rows, is_there));
}

Numbers positions(std::size_t size) {
  Numbers numbers(size);
  for (std::size_t scan = 0; scan < size; ++scan) numbers[scan] = static_cast<std::int64_t>(scan);
  return numbers;
}

// Empty unless every name has one and no two are the same.
Numbers numbers_in_names(const Files& files) {
  Numbers numbers;
  for (const auto& file : files) {
    const auto number = number_in_name(file);
    if (!number) return {};
    numbers.push_back(*number);
  }
  const bool distinct = std::set(numbers.begin(), numbers.end()).size() == numbers.size();
  return distinct ? numbers : Numbers{};
}

Rows match_names(const Files& files, const PoseTable& table) {
  std::map<std::string, std::size_t> by_name, by_stem;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const auto name = std::filesystem::path(table.rows[row].file).filename();
    by_name.emplace(name.string(), row);
    by_stem.emplace(name.stem().string(), row);
  }
  Rows rows(files.size());
  for (std::size_t scan = 0; scan < files.size(); ++scan) {
    const std::string name = files[scan].filename().string(), stem = files[scan].stem().string();
    if (by_name.contains(name)) {
      rows[scan] = by_name[name];
    } else if (by_name.contains(stem)) {
      rows[scan] = by_name[stem];
    } else if (by_stem.contains(stem)) {
      rows[scan] = by_stem[stem];
    }
  }
  return rows;
}

Rows match_times(const Numbers& utimes_us, const PoseTable& table) {
  std::map<std::int64_t, std::size_t> by_time;
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    by_time.emplace(table.rows[row].utime_us, row);
  Rows rows;
  for (const std::int64_t utime_us : utimes_us) {
    auto at = by_time.lower_bound(utime_us);
    if (at != by_time.begin() &&
        (at == by_time.end() || utime_us - std::prev(at)->first <= at->first - utime_us))
      --at;
    const bool near = at != by_time.end() && std::abs(at->first - utime_us) <= kSameTime_us;
    rows.push_back(near ? std::optional(at->second) : std::nullopt);
  }
  return rows;
}

// A way to count scans: row n of the table is the scan of number n + shift.
struct Counting {
  const Numbers& numbers;
  std::int64_t shift;
  std::string told;
};

Rows match_numbers(const Counting& counting, const PoseTable& table) {
  std::map<std::int64_t, std::size_t> by_number;
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    by_number.emplace(table.rows[row].scan + counting.shift, row);
  Rows rows;
  for (const std::int64_t number : counting.numbers) {
    const auto found = by_number.find(number);
    rows.push_back(found == by_number.end() ? std::nullopt : std::optional(found->second));
  }
  return rows;
}

// The counting that finds the most rows, the first of equals.
RowMatch best_of(const std::vector<Counting>& countings, const PoseTable& table) {
  RowMatch best;
  for (const Counting& counting : countings) {
    Rows rows = match_numbers(counting, table);
    if (!best.rows.empty() && count(rows) <= count(best.rows)) continue;
    best.rows = std::move(rows);
    best.notes.clear();
    if (!counting.told.empty()) best.notes.push_back(counting.told);
  }
  return best;
}

// Names decide, unless most rows have no partner by them.
RowMatch match_numbers(const Files& files, const PoseTable& table) {
  const Numbers named = numbers_in_names(files), placed = positions(files.size());
  const Counting by_position{placed, 0, named.empty() ? "" : "the rows count the scans from 0"};
  if (!table.has_scans && table.rows.size() + table.unknown == files.size())
    return {match_numbers({placed, 0, ""}, table), {}};
  RowMatch match;
  if (!named.empty()) {
    match = best_of({{named, 0, ""},
                     {named, -1, "the rows count one more than the scans' names"},
                     {named, 1, "the rows count one less than the scans' names"}},
                    table);
    if (3 * count(match.rows) >= 2 * std::min(files.size(), table.rows.size())) return match;
  }
  RowMatch other = best_of({by_position, {placed, -1, "the rows count the scans from 1"}}, table);
  return count(other.rows) > count(match.rows) || match.rows.empty() ? other : match;
}

RowMatch find_rows(const Files& files, const Numbers& utimes_us, const PoseTable& table) {
  if (table.has_files) {
    if (RowMatch named{match_names(files, table), {}}; !named.empty()) return named;
  } else if (table.has_times && !table.has_scans && !utimes_us.empty()) {
    if (RowMatch timed{match_times(utimes_us, table), {}}; !timed.empty()) return timed;
  }
  return match_numbers(files, table);
}

// "row 3 has no scan", "rows 3, 4 and 7 more have no scan".
std::string sentence(const std::string& kind, const std::vector<std::string>& names,
                     const std::string& what) {
  if (names.size() == 1) return fmt::format("{}{} has no {}", kind, names.front(), what);
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kTold); ++i)
    list += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kTold) list += fmt::format(" and {} more", names.size() - kTold);
  return fmt::format("{}{} have no {}", kind.empty() ? "" : "rows ", list, what);
}

void tell_rows(const PoseTable& table, RowMatch& match) {
  std::set<std::size_t> used;
  for (const auto& row : match.rows)
    if (row) used.insert(*row);
  if (const std::string note = rows_without_scan(table, used); !note.empty())
    match.notes.push_back(note);
  std::ranges::copy(notes_on(table), std::back_inserter(match.notes));
}

void tell_scans(const Files& files, RowMatch& match) {
  std::vector<std::string> without;
  for (std::size_t scan = 0; scan < files.size(); ++scan)
    if (!match.rows[scan]) without.push_back(files[scan].filename().string());
  if (!without.empty()) match.notes.push_back(sentence("", without, "row"));
}

}  // namespace

std::string rows_without_scan(const PoseTable& table, const std::set<std::size_t>& used) {
  std::vector<std::string> unused;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (!used.contains(row))
      unused.push_back(table.has_files ? table.rows[row].file
                                       : std::to_string(table.rows[row].scan));
  }
  return unused.empty() ? "" : sentence("row ", unused, "scan");
}

bool RowMatch::empty() const { return count(rows) == 0; }

Numbers scan_numbers(const Files& files) {
  const Numbers named = numbers_in_names(files);
  return !named.empty() && std::ranges::is_sorted(named) ? named : positions(files.size());
}

RowMatch match_rows(const Files& files, const Numbers& utimes_us, const PoseTable& table) {
  RowMatch match = find_rows(files, utimes_us, table);
  tell_rows(table, match);
  tell_scans(files, match);
  return match;
}

}  // namespace voxlist::io
