#include "voxlist/io/scans/folder_events.h"

#include <algorithm>

#include "voxlist/io/files/file.h"

namespace voxlist::io {
namespace {

// Odometry farther from the scans than this (us) is about something else.
constexpr std::int64_t kMargin_us = 1'000'000;

std::vector<FolderEvent> odometry_of(const ScanFolder& folder) {
  std::vector<FolderEvent> events;
  if (!folder.odometry()) return events;
  const std::int64_t from = folder.utime_us(0) - kMargin_us;
  const std::int64_t to = folder.utime_us(folder.size() - 1) + kMargin_us;
  const auto& rows = folder.odometry()->rows;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::int64_t utime_us = rows[row].utime_us;
    if (utime_us >= from && utime_us <= to) events.push_back({utime_us, false, row});
  }
  if (events.empty()) {
    throw FileError(folder.file(0).parent_path() / "odometry.csv",
                    "is of another time than the scans, give their times in poses.csv");
  }
  return events;
}

}  // namespace

std::vector<FolderEvent> events_of(const ScanFolder& folder) {
  std::vector<FolderEvent> events = odometry_of(folder);
  for (std::size_t scan = 0; scan < folder.size(); ++scan) {
    events.push_back({folder.utime_us(scan), true, scan});
  }
  std::ranges::stable_sort(events, {}, &FolderEvent::utime_us);
  return events;
}

}  // namespace voxlist::io
