#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "services/voxlist/recording/recording.h"
#include "services/voxlist/recording/scan_points.h"
#include "services/voxlist/recording/scan_times.h"
#include "voxlist/adapter/adapter_config.h"
#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/odometry_buffer.h"
#include "voxlist/geometry/tilt.h"

namespace voxlist::desk {

/// A scan with what was known when it came.
struct Scan {
  /// In the folder or log, from 0.
  std::int64_t number = 0;
  /// In base.
  Cloud cloud;
  /// Odometry's pose at the scan's time, if there is odometry.
  std::optional<Pose2> T_odom_base;
  std::optional<Tilt> odometry_tilt;  ///< where odometry measures roll and pitch
};

/// The scans of a folder or a log, one by one, as the services get them over the bus.
class ScanInput {
 public:
  /// Throws FileError when the path is neither a folder of scans nor a log (`prefix`: of its
  /// channels). Points outside the limits are only told. Where `adapter` has sensors, the scans are
  /// made of what these say (adapted_recording.h).
  ScanInput(std::filesystem::path path, Console& console, const RangeLimits& limits = {},
            const std::string& prefix = {}, const adapter::AdapterConfig& adapter = {});

  /// The next scan; nothing at the end, or after Ctrl-C. What cannot be read is left out. Throws
  /// FileError when there was not one scan, or when the scans' times are in another unit.
  std::optional<Scan> next();

  /// How far it has come, 0..1.
  double progress() const { return recording_->progress(); }

  /// Whether the scans' times are known; else they come once a second.
  bool has_times() const { return recording_->has_times(); }

  /// How the rows of a pose table are found, which must outlive the answer.
  RowOfScan match(const io::PoseTable& poses) const { return recording_->match(poses); }

  const std::filesystem::path& path() const { return path_; }
  const Omissions& omissions() const { return omissions_; }

  /// Scans read so far, and the time from the first to the last.
  std::int64_t scans() const { return times_.scans(); }
  double seconds() const {
    return static_cast<double>(times_.last_us() - times_.first_us()) * 1e-6;
  }

 private:
  [[noreturn]] void refuse_all() const;
  std::optional<Scan> take(CloudRecord& record);
  std::optional<Scan> take(const OdometryRecord& record);
  std::optional<Scan> take(const TruthRecord&) { return std::nullopt; }
  std::optional<Scan> take(const RawRecord&) { return std::nullopt; }  // none: they are adapted

  const std::filesystem::path path_;
  Omissions omissions_;
  const std::unique_ptr<Recording> recording_;
  const RangeLimits limits_;
  OdometryBuffer odometry_;
  ScanTimes times_;
};

}  // namespace voxlist::desk
