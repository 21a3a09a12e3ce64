#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/geometry/pose.h"

namespace voxlist::io {

/// One line of a pose table.
struct PoseRow {
  /// The scan's number: from the column index or scan; else the last number in the file's name;
  /// else the row's position from 0.
  std::int64_t scan = 0;
  /// The scan's file name as written; empty when the table has no such column.
  std::string file;
  std::int64_t utime_us = 0;
  Pose3 pose = Pose3::Identity();
};

/// Poses with what the table said about them.
struct PoseTable {
  std::vector<PoseRow> rows;
  /// The table numbers its scans (column index or scan).
  bool has_scans = false;
  /// The table names its scans' files.
  bool has_files = false;
  /// The table gives times; otherwise utime_us is scan * 1 s.
  bool has_times = false;
  /// The table gives z; otherwise z is 0.
  bool has_heights = false;
  /// Rows left out because their x and y are nan or inf: poses that nobody knows.
  std::size_t unknown = 0;
  /// What a person should know: units that look wrong.
  std::vector<std::string> notes = {};
};

/// Reads poses in any form that is known, by the content:
///
/// | form | a row |
/// |---|---|
/// | table with a header | see read_pose_csv |
/// | TUM | t x y z qx qy qz qw, t in seconds |
/// | KITTI | the upper 3 or all 4 rows of the matrix T_map_base, row by row; scan = row from 0 |
/// | EuRoC | t, x, y, z, qw, qx, qy, qz, ... with its header or without, t in nanoseconds |
///
/// Throws FileError as read_pose_csv does.
PoseTable read_poses(const std::filesystem::path& path);

/// What a person should know of a table: its notes, and how many rows are unknown poses.
std::vector<std::string> notes_on(const PoseTable& table);

/// Reads a table of poses by its header; columns may be in any order, others are ignored.
///
/// | meaning | names (any case; units as suffix or not: x, x_m, "X [m]") |
/// |---|---|
/// | scan number | index, scan (which may hold file names instead), scan_index, scan_number |
/// | file name | file, filename, file_name, scan_file |
/// | time in microseconds | utime, utime_us, timestamp_us, time_us, t_us |
/// | time in nanoseconds | utime_ns, timestamp_ns, time_ns, t_ns; timestamp of EuRoC |
/// | time in seconds, if there is no other | t, t_s, time, time_s, timestamp, timestamp_s |
/// | position (m) | x, y, and z or not; tx, p_x, pos_x, position_x, p_rs_r_x, ... |
/// | heading (rad; degrees with the suffix _deg) | yaw, and roll and pitch or not (R = Rz Ry Rx),
/// or qx, qy, qz, qw, or q_x, quat_x, orientation_x, q_rs_x, ... |
///
/// A row whose x and y are nan or inf is counted as unknown and left out. Throws
/// FileError (with line and column) on: missing columns, more cells than columns, no rows, what is
/// not a finite number, a quaternion more than 1 % off unit length, a scan or file that comes
/// twice.
PoseTable read_pose_csv(const std::filesystem::path& path);

/// The same for odometry: the table must give times, and they must not go backwards.
PoseTable read_odometry_csv(const std::filesystem::path& path);

/// A unit quaternion from components that are within 1 % of unit length; otherwise nothing.
std::optional<Eigen::Quaterniond> unit_quaternion(double w, double x, double y, double z);

/// The last run of digits in a file's name (without folder and extension); nothing when there is
/// none, it is longer than 9 digits, or the name tells a time (time_in_name).
std::optional<std::int64_t> number_in_name(const std::filesystem::path& file);

}  // namespace voxlist::io
