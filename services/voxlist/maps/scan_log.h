#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "voxlist/matching/localisation/localisation.h"

namespace voxlist::desk {

/// Name of the file in a map folder that tells what was said of each scan when it came.
inline constexpr const char* kScanLogFile = "scans.csv";

/// What was said of one scan when it came. Where it has its place at last, the trajectory says.
struct ScanRow {
  std::int64_t number = 0;  ///< in the folder or log, from 0
  std::int64_t utime_us = 0;
  matching::LocalisationState state = matching::LocalisationState::kLost;
  double probability = 0.0;  ///< that the first mode is right
  double elapsed_ms = 0.0;   ///< of work on it, by the wall's clock: no two runs have it alike
};

/// Writes them as CSV, atomically: scan,utime_us,state,probability,elapsed_ms. Throws FileError.
void write_scan_log(const std::filesystem::path& folder, const std::vector<ScanRow>& rows);

/// Reads a folder's; nothing where there is none. Throws FileError, with the line, on what is no
/// such row.
std::optional<std::vector<ScanRow>> read_scan_log(const std::filesystem::path& folder);

}  // namespace voxlist::desk
