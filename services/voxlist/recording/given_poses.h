#pragma once

#include <filesystem>
#include <optional>

#include "services/voxlist/recording/scan_input.h"
#include "voxlist/io/poses/pose_file.h"

namespace voxlist::desk {

/// A table that says where each scan was taken: matched as poses.csv in a scan folder, in a log by
/// time (to 0.01 s) where the table has times, else by the scan's number.
class GivenPoses {
 public:
  /// Throws FileError when the file is no table of poses.
  GivenPoses(const std::filesystem::path& path, const ScanInput& input)
      : table_(io::read_poses(path)), row_of_(input.match(table_)) {}
  GivenPoses(const GivenPoses&) = delete;
  GivenPoses& operator=(const GivenPoses&) = delete;

  /// T_map_base of the scan; nothing when the table does not have it.
  std::optional<Pose3> of(const Scan& scan) const {
    const auto row = row_of_(scan.number, scan.cloud.utime_us);
    return row ? std::optional(table_.rows[*row].pose) : std::nullopt;
  }

 private:
  const io::PoseTable table_;
  const RowOfScan row_of_;
};

}  // namespace voxlist::desk
