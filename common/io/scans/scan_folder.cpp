#include "voxlist/io/scans/scan_folder.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string>

#include "voxlist/io/clouds/cloud_file.h"
#include "voxlist/io/files/natural_order.h"

namespace voxlist::io {
namespace {

namespace fs = std::filesystem;
using Files = std::vector<fs::path>;
using Rows = std::vector<std::optional<std::size_t>>;

// Time between scans of which no table says when they were taken (us).
constexpr std::int64_t kDefaultPeriod_us = 1'000'000;

std::string lower(std::string text) {
  for (char& c : text) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return text;
}

bool is_cloud(const fs::path& file) {
  const std::string extension = lower(file.extension().string());
  return extension == ".ply" || extension == ".pcd";
}

Files clouds_in(const fs::path& folder) {
  std::error_code failure;
  Files files;
  for (const auto& entry : fs::directory_iterator(folder, failure)) {
    if (is_cloud(entry.path())) {
      files.push_back(entry.path());
    }
  }
  if (failure) {
    throw FileError(folder, "no folder that can be read, give the folder that holds the scans");
  }
  return files;
}

Files find_scans(const fs::path& folder) {
  Files files = clouds_in(folder);
  const auto is_other = [](const fs::path& file) {
    return !lower(file.filename().string()).starts_with("scan_");
  };
  if (!std::all_of(files.begin(), files.end(), is_other)) {
    std::erase_if(files, is_other);
  }
  if (files.empty()) {
    throw FileError(folder, "has no scans, put scan_000.ply (or .pcd), scan_001.ply, ... there");
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  for (std::size_t i = 1; i < files.size(); ++i) {
    if (files[i].stem() == files[i - 1].stem()) {
      throw FileError(files[i], "is there in two formats, keep one");
    }
  }
  return files;
}

Rows match_names(const Files& files, const PoseTable& table) {
  std::map<std::string, std::size_t> by_name, by_stem;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const fs::path name = fs::path(table.rows[row].file).filename();
    by_name.emplace(name.string(), row);
    by_stem.emplace(is_cloud(name) ? name.stem().string() : name.string(), row);
  }
  Rows rows(files.size());
  for (std::size_t scan = 0; scan < files.size(); ++scan) {
    if (const auto named = by_name.find(files[scan].filename().string()); named != by_name.end()) {
      rows[scan] = named->second;
    } else if (const auto same = by_stem.find(files[scan].stem().string()); same != by_stem.end()) {
      rows[scan] = same->second;
    }
  }
  return rows;
}

std::vector<std::int64_t> positions(std::size_t size) {
  std::vector<std::int64_t> numbers;
  for (std::size_t scan = 0; scan < size; ++scan) {
    numbers.push_back(static_cast<std::int64_t>(scan));
  }
  return numbers;
}

bool contain_all(const std::vector<std::int64_t>& numbers, const PoseTable& table) {
  const std::set<std::int64_t> known(numbers.begin(), numbers.end());
  return std::all_of(table.rows.begin(), table.rows.end(),
                     [&](const PoseRow& row) { return known.contains(row.scan); });
}

/// What the table's scan numbers mean: positions, or the numbers in the file names.
std::vector<std::int64_t> scan_numbers(const Files& files, const PoseTable& table) {
  const std::vector<std::int64_t> by_position = positions(files.size());
  std::vector<std::int64_t> by_name;
  for (const fs::path& file : files) {
    by_name.push_back(number_in_name(file).value_or(-1));
  }
  const bool use_names = !contain_all(by_position, table) && contain_all(by_name, table);
  return use_names ? by_name : by_position;
}

Rows match_numbers(const Files& files, const PoseTable& table) {
  std::map<std::int64_t, std::size_t> by_number;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    by_number.emplace(table.rows[row].scan, row);
  }
  Rows rows;
  for (const std::int64_t number : scan_numbers(files, table)) {
    const auto found = by_number.find(number);
    rows.push_back(found == by_number.end() ? std::nullopt : std::optional(found->second));
  }
  return rows;
}

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

}  // namespace

ScanFolder::ScanFolder(const fs::path& folder) : files_(find_scans(folder)), rows_(files_.size()) {
  for (const std::int64_t position : positions(files_.size())) {
    utimes_us_.push_back(position * kDefaultPeriod_us);
  }
  if (fs::exists(folder / "poses.csv")) {
    read_poses(folder / "poses.csv");
  }
  if (fs::exists(folder / "odometry.csv")) {
    odometry_ = read_odometry_csv(folder / "odometry.csv");
  }
}

void ScanFolder::read_poses(const fs::path& path) {
  poses_ = read_pose_csv(path);
  rows_ = match(*poses_);
  std::map<std::int64_t, std::int64_t> known;
  for (const std::int64_t scan : positions(files_.size())) {
    if (const auto row = rows_[static_cast<std::size_t>(scan)]) {
      known[scan] = poses_->rows[*row].utime_us;
    }
  }
  if (known.empty()) {
    throw FileError(path, "matches none of the scans, check its index or file column");
  }
  if (!poses_->has_times) {
    return;
  }
  for (const std::int64_t scan : positions(files_.size())) {
    utimes_us_[static_cast<std::size_t>(scan)] = time_of(scan, known);
  }
  for (std::size_t scan = 1; scan < utimes_us_.size(); ++scan) {
    if (utimes_us_[scan] <= utimes_us_[scan - 1]) {
      throw FileError(
          path,
          fmt::format("puts {} no later than {}, number the scans in order of time",
                      files_[scan].filename().string(), files_[scan - 1].filename().string()));
    }
  }
}

Cloud ScanFolder::read(std::size_t scan) const {
  Cloud cloud = read_cloud_file(files_[scan]);
  cloud.utime_us = utimes_us_[scan];
  return cloud;
}

std::optional<Pose3> ScanFolder::truth(std::size_t scan) const {
  return rows_[scan] ? std::optional(poses_->rows[*rows_[scan]].pose) : std::nullopt;
}

std::vector<std::optional<std::size_t>> ScanFolder::match(const PoseTable& table) const {
  return table.has_files ? match_names(files_, table) : match_numbers(files_, table);
}

}  // namespace voxlist::io
