#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/io/clouds/raw_scan.h"
#include "voxlist/io/poses/pose_file.h"
#include "voxlist/io/scans/row_match.h"

namespace voxlist::io {

/// A folder of recorded scans: scan_*.ply and scan_*.pcd, or every *.ply and *.pcd when none is
/// named so; beside them, where there, poses.csv (truth, and the source of the scans' times; any
/// form of read_poses) and odometry.csv. Hidden files, map.ply (which Voxlist makes) and what is no
/// regular file are no scans. Where there are none of these, every *.bin is one, as in the folder
/// `velodyne` of the KITTI data sets, with their times.txt beside the folder or in it.
///
/// A scan's number is its position, from 0, in the natural order of the names (scan_9 before
/// scan_10), or of the times in their names, where all have one (time_in_name). Times come from
/// poses.csv, whose rows belong to scans as match_rows says; scans that it leaves out lie evenly
/// between those that it has (by the numbers in the names, where there), or 1 s apart at the ends;
/// or they have the times in their names, where those are the table's, too. Without poses.csv, or
/// without times in it, scans have the times in their names, else they come once a second from
/// utime 0.
class ScanFolder {
 public:
  /// Looks at names and tables; scans are read one by one later. Throws FileError when there is no
  /// such folder, there are no scans, a table is damaged or matches no scan, or times do not
  /// increase with the names or are in another unit.
  explicit ScanFolder(const std::filesystem::path& folder);

  std::size_t size() const { return files_.size(); }
  const std::filesystem::path& file(std::size_t scan) const { return files_[scan]; }
  std::int64_t utime_us(std::size_t scan) const { return utimes_us_[scan]; }

  /// Whether poses.csv or the names give the times; else the scans come once a second.
  bool has_times() const { return !in_names_.empty() || (poses_ && poses_->has_times); }

  /// Reads a scan and sets its time. Throws FileError.
  Cloud read(std::size_t scan) const;

  /// The same with all that the file tells of each point.
  RawScan read_raw(std::size_t scan) const;

  /// Where poses.csv says that the scan was taken (T_map_base), if it does.
  std::optional<Pose3> truth(std::size_t scan) const;

  /// poses.csv and odometry.csv as they were read, where they are there.
  const std::optional<PoseTable>& poses() const { return poses_; }
  const std::optional<PoseTable>& odometry() const { return odometry_; }

  /// The rows of another table.
  RowMatch match(const PoseTable& table) const { return match_rows(files_, utimes_us_, table); }

  /// What a person should know of how poses.csv and the scans belong together.
  const std::vector<std::string>& notes() const { return rows_.notes; }

  /// And of the files: what is left out, and that the times are those in their names.
  const std::vector<std::string>& file_notes() const { return notes_; }

 private:
  void take_times_in_names();
  void take_times_of_kitti(const std::filesystem::path& folder);
  bool names_agree() const;
  void take_times_of_rows();
  void take_poses(const std::filesystem::path& path);
  void check_times(const std::filesystem::path& path) const;
  void check_order(const std::filesystem::path& path, std::size_t scan) const;

  std::vector<std::filesystem::path> files_;
  std::vector<std::int64_t> in_names_;  // times, where all names have one, or KITTI's times.txt
  std::vector<std::int64_t> utimes_us_;
  std::string time_note_;
  std::vector<std::string> notes_;
  std::optional<PoseTable> poses_;
  std::optional<PoseTable> odometry_;
  RowMatch rows_;
};

}  // namespace voxlist::io
