#pragma once

#include <filesystem>
#include <optional>

#include "io/pose_file.h"
#include "services/voxlist/scan_input.h"

namespace voxlist {

/// A table that says where each scan was taken: matched as poses.csv in a scan folder, in a log by
/// time (to 0.01 s) where the table has times, else by the scan's number.
class GivenPoses {
 public:
  /// Throws FileError when the file is no table of poses.
  GivenPoses(const std::filesystem::path& path, const ScanInput& input)
      : table_(read_pose_csv(path)), row_of_(input.match(table_)) {}
  GivenPoses(const GivenPoses&) = delete;
  GivenPoses& operator=(const GivenPoses&) = delete;

  /// T_map_base of the scan; nothing when the table does not have it.
  std::optional<Pose3> of(const Scan& scan) const {
    const auto row = row_of_(scan.number, scan.cloud.utime_us);
    return row ? std::optional(table_.rows[*row].pose) : std::nullopt;
  }

 private:
  const PoseTable table_;
  const RowOfScan row_of_;
};

}  // namespace voxlist
