#include "voxlist/io/scans/scan_folder.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "voxlist/geometry/time_limit.h"
#include "voxlist/io/clouds/cloud_file.h"
#include "voxlist/io/files/cursor.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/files/time_in_name.h"
#include "voxlist/io/scans/scan_files.h"

namespace voxlist::io {
namespace {

namespace fs = std::filesystem;
using Files = std::vector<fs::path>;

// Scans that come closer together than this (us) have times in another unit: no 3D scanner makes
// 200 a second.
constexpr std::int64_t kLeastPeriod_us = 5'000;

// How far a row's time may be from its scan's (us): what rounding to hundredths of a second costs.
constexpr std::int64_t kSameTime_us = 10'000;

// Time between scans of which no table says when they were taken (us).
constexpr std::int64_t kDefaultPeriod_us = 1'000'000;

/// The time of a scan from those of others (at least one).
std::int64_t time_of(std::int64_t scan, const std::map<std::int64_t, std::int64_t>& known) {
  const auto after = known.lower_bound(scan);
  if (after == known.end() || after == known.begin()) {
    const auto& [nearest, time] = after == known.end() ? *known.rbegin() : *after;
    return time + (scan - nearest) * kDefaultPeriod_us;
  }
  const auto before = std::prev(after);
  const std::int64_t step = (after->second - before->second) / (after->first - before->first);
  return after->second - step * (after->first - scan);
}

// The first n lines, in seconds.
std::vector<std::int64_t> read_times(const fs::path& path, std::size_t n) try {
  const std::string text = read_file(path) + '\n';
  std::string_view rest = text;
  std::vector<std::int64_t> utimes_us;
  while (utimes_us.size() < n) {
    std::string_view line = take_line(rest);
    const double time_s = parse_number(take_word(line));
    if (!(time_s >= 0.0 && time_s < static_cast<double>(kMaxUtime_us) * 1e-6))
      throw FormatError("has a time that is no seconds");
    utimes_us.push_back(std::llround(time_s * 1e6));
  }
  return utimes_us;
} catch (const FormatError& error) {
  throw FileError(path, fmt::format("{}: it must have a time in seconds for each of {} scans",
                                    error.what(), n));
}

}  // namespace

ScanFolder::ScanFolder(const fs::path& folder) {
  ScanFiles found = find_scan_files(folder);
  files_ = std::move(found.files);
  notes_ = std::move(found.notes);
  rows_.rows.resize(files_.size());
  take_times_in_names();
  take_times_of_kitti(folder);
  if (fs::exists(folder / "poses.csv")) {
    take_poses(folder / "poses.csv");
  }
  if (utimes_us_.empty() && !in_names_.empty()) {
    utimes_us_ = in_names_;
    check_times(folder);
    notes_.push_back(time_note_);
  }
  for (auto scan = static_cast<std::int64_t>(utimes_us_.size()); utimes_us_.size() < files_.size();
       ++scan) {
    utimes_us_.push_back(scan * kDefaultPeriod_us);
  }
  if (fs::exists(folder / "odometry.csv")) {
    odometry_ = read_odometry_csv(folder / "odometry.csv");
  }
}

// Names are sorted as times then: 1.5 comes after 1.25.
void ScanFolder::take_times_in_names() {
  std::vector<std::pair<TimeInName, fs::path>> timed;
  for (const fs::path& file : files_) {
    const auto time = time_in_name(file);
    if (!time) return;
    timed.emplace_back(*time, file);
  }
  std::ranges::stable_sort(timed, {}, [](const auto& scan) { return scan.first.utime_us; });
  std::ranges::transform(timed, files_.begin(), [](const auto& scan) { return scan.second; });
  for (const auto& [time, file] : timed) in_names_.push_back(time.utime_us);
  time_note_ = fmt::format("the scans' times are those in their names, in {}",
                           name(timed.front().first.unit));
}

// KITTI's folder velodyne has its times beside it, or in it.
void ScanFolder::take_times_of_kitti(const fs::path& folder) {
  if (!in_names_.empty() || lower_case(files_.front().extension().string()) != ".bin") return;
  for (const fs::path& path : {folder / "times.txt", folder / ".." / "times.txt"}) {
    if (!fs::exists(path)) continue;
    in_names_ = read_times(path, files_.size());
    time_note_ = fmt::format("the scans' times are those of {}", path.lexically_normal().string());
    return;
  }
}

void ScanFolder::take_poses(const fs::path& path) {
  poses_ = read_poses(path);
  rows_ = match_rows(files_, in_names_, *poses_);
  if (rows_.empty()) {
    throw FileError(path, "matches none of the scans, check its index or file column");
  }
  if (!poses_->has_times || names_agree()) return;
  take_times_of_rows();
  check_times(path);
}

// Whether the table gives the scans the times that their names tell.
bool ScanFolder::names_agree() const {
  if (in_names_.empty()) return false;
  for (std::size_t scan = 0; scan < files_.size(); ++scan) {
    const auto row = rows_.rows[scan];
    if (row && std::abs(poses_->rows[*row].utime_us - in_names_[scan]) > kSameTime_us) return false;
  }
  return true;
}

void ScanFolder::take_times_of_rows() {
  const std::vector<std::int64_t> numbers = scan_numbers(files_);
  std::map<std::int64_t, std::int64_t> known;
  for (std::size_t scan = 0; scan < files_.size(); ++scan) {
    if (const auto row = rows_.rows[scan]) known[numbers[scan]] = poses_->rows[*row].utime_us;
  }
  for (const std::int64_t number : numbers) {
    utimes_us_.push_back(time_of(number, known));
  }
}

void ScanFolder::check_times(const fs::path& path) const {
  const auto [first, last] = std::ranges::minmax(utimes_us_);
  const auto steps = static_cast<std::int64_t>(utimes_us_.size()) - 1;
  if (steps > 0 && first == last) {
    throw FileError(path, "gives all scans the same time, leave the column out or mend it");
  }
  for (std::size_t scan = 1; scan < utimes_us_.size(); ++scan) check_order(path, scan);
  if (steps > 0 && (last - first) / steps < kLeastPeriod_us) {
    throw FileError(path, fmt::format("puts scans {} us apart: are its times in seconds or "
                                      "milliseconds? utime is in microseconds, t in seconds",
                                      (last - first) / steps));
  }
}

void ScanFolder::check_order(const fs::path& path, std::size_t scan) const {
  const std::int64_t step_us = utimes_us_[scan] - utimes_us_[scan - 1];
  if (step_us > 0) return;
  const std::string own = files_[scan].filename(), before = files_[scan - 1].filename();
  throw FileError(
      path, step_us == 0
                ? fmt::format("gives {} and {} the same time, give each its own (with "
                              "decimals, if they are whole seconds)",
                              before, own)
                : fmt::format("puts {} before {}, number the scans in order of time", own, before));
}

Cloud ScanFolder::read(std::size_t scan) const {
  Cloud cloud = read_cloud_file(files_[scan]);
  cloud.utime_us = utimes_us_[scan];
  return cloud;
}

RawScan ScanFolder::read_raw(std::size_t scan) const {
  RawScan raw = read_raw_scan(files_[scan]);
  raw.cloud.utime_us = utimes_us_[scan];
  return raw;
}

std::optional<Pose3> ScanFolder::truth(std::size_t scan) const {
  const auto row = rows_.rows[scan];
  return row ? std::optional(poses_->rows[*row].pose) : std::nullopt;
}

}  // namespace voxlist::io
