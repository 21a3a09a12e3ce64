#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "services/voxlist/recording/omissions.h"

namespace voxlist::desk {

/// Looks at the times of scans before they are used. A scan that is no later than the one before is
/// left out; times that are no microseconds are refused as a whole, with what to do about them.
class ScanTimes {
 public:
  /// Both must outlive it.
  ScanTimes(const std::filesystem::path& path, Omissions& omissions)
      : path_(path), omissions_(omissions) {}

  /// Whether the scan's time goes on from those before. Throws FileError when three scans have come
  /// closer together than any scanner makes them.
  bool take(std::int64_t number, std::int64_t utime_us);

  /// Throws FileError when the scans' times are why there is at most one scan, or two that come too
  /// close together.
  void check_at_end() const;

  /// Scans taken, and the times of the first and the last.
  std::int64_t scans() const { return scans_; }
  std::int64_t first_us() const { return first_us_; }
  std::int64_t last_us() const { return last_us_; }

 private:
  void leave_out(std::int64_t number, const std::string& reason);
  void check_period() const;
  void remark_on_period() const;

  const std::filesystem::path& path_;
  Omissions& omissions_;
  std::int64_t scans_ = 0, first_us_ = 0, last_us_ = 0;
  std::int64_t too_late_ = 0, latest_us_ = 0;  // no microseconds
  std::int64_t repeated_ = 0, backwards_ = 0;
};

}  // namespace voxlist::desk
