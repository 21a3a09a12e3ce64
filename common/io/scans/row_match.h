#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "voxlist/io/poses/pose_file.h"

namespace voxlist::io {

/// Which row of a pose table belongs to which scan of a folder.
struct RowMatch {
  /// Finds each scan's row, if there is one.
  std::vector<std::optional<std::size_t>> rows;

  /// What a person should know: rows without a scan, scans without a row, how the table counts.
  std::vector<std::string> notes;

  bool empty() const;
};

/// Says which rows of a table have no scan: "row 3 has no scan". Empty when all have one.
std::string rows_without_scan(const PoseTable& table, const std::set<std::size_t>& used);

/// Numbers of scans that tell how far apart they were taken: the last number in each name where all
/// have one and they increase, else the positions.
std::vector<std::int64_t> scan_numbers(const std::vector<std::filesystem::path>& files);

/// Matches rows with scans, by the first of these that fits:
/// - names, where the table has them (the extension may differ);
/// - times (to 0.01 s), where the table has times but no numbers; `utimes_us` are the scans' own,
/// or
///   none;
/// - row by row, where the table has neither names nor numbers but as many rows as there are scans;
/// - the last number in the scans' names, where two thirds of the rows (or of the scans, if these
///   are fewer) have a partner by it; the table may count one off from the names;
/// - the scans' positions, from 0 or from 1.
RowMatch match_rows(const std::vector<std::filesystem::path>& files,
                    const std::vector<std::int64_t>& utimes_us, const PoseTable& table);

}  // namespace voxlist::io
