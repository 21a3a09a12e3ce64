#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "voxlist/io/scans/scan_folder.h"

namespace voxlist::io {

/// A row of a scan folder's odometry.csv, or a scan (with its truth, where there is one).
struct FolderEvent {
  std::int64_t utime_us = 0;
  bool is_scan = false;
  /// The row, or the scan's number.
  std::size_t number = 0;
};

/// What a folder tells, in the order of time, odometry before the scan of the same time. Odometry
/// more than a second before the first scan or after the last is left out. Throws FileError when
/// nothing of it is left: then its times are not those of the scans.
std::vector<FolderEvent> events_of(const ScanFolder& folder);

}  // namespace voxlist::io
