#pragma once

#include <filesystem>
#include <optional>

#include "services/voxlist/output/console.h"
#include "services/voxlist/recording/scan_input.h"
#include "voxlist/io/poses/pose_file.h"

namespace voxlist::desk {

/// A table that says where each scan was taken: matched as poses.csv in a scan folder, in a log by
/// time (to 0.01 s) where the table has times, else by the scan's number.
///
/// Poses far from the origin (UTM) are moved near it, by the first one's whole metres: no map
/// reaches that far. Heights are counted from their median: a robot's base is at height 0 of its
/// map.
class GivenPoses {
 public:
  /// Throws FileError when the file is no table of poses, or they lie farther apart than a map
  /// reaches. Tells when it moves them.
  GivenPoses(const std::filesystem::path& path, const ScanInput& input, Console& console);
  GivenPoses(const GivenPoses&) = delete;
  GivenPoses& operator=(const GivenPoses&) = delete;

  /// T_map_base of the scan and its time, which is the table's where the input knows none; nothing
  /// when the table does not have the scan.
  std::optional<StampedPose3> of(const Scan& scan) const {
    const auto row = row_of_(scan.number, scan.cloud.utime_us);
    if (!row) return std::nullopt;
    const io::PoseRow& found = table_.rows[*row];
    return StampedPose3{has_times_ ? scan.cloud.utime_us : found.utime_us, found.pose};
  }

  /// What was taken off each position (m); zero of level poses near the origin.
  const Eigen::Vector3d& offset_m() const { return offset_m_; }

 private:
  io::PoseTable table_;
  const RowOfScan row_of_;
  const bool has_times_;
  Eigen::Vector3d offset_m_ = Eigen::Vector3d::Zero();
};

}  // namespace voxlist::desk
