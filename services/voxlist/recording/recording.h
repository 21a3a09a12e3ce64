#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/voxlist/recording/omissions.h"
#include "voxlist/io/poses/pose_file.h"

namespace voxlist::desk {

/// A scan as it is sent, and its number in the recording, from 0: those that cannot be read count.
struct CloudRecord {
  std::int64_t number = 0;
  pointcloud_t message;
};

struct OdometryRecord {
  pose_t message;
};

struct TruthRecord {
  pose_t message;
};

/// What a laser said on a channel of its own: an encoded pointcloud_t, and its number among those
/// of all lasers, from 0.
struct RawRecord {
  std::int64_t number = 0;
  std::string channel;
  std::vector<std::uint8_t> bytes;
};

using Record = std::variant<CloudRecord, OdometryRecord, TruthRecord, RawRecord>;

/// The row of a pose table that belongs to a scan, by the scan's number and time.
using RowOfScan =
    std::function<std::optional<std::size_t>(std::int64_t number, std::int64_t utime_us)>;

/// Recorded scans, odometry and truth as messages in the order of time. A folder of scans gives the
/// very messages that its log holds, so that both make the same map.
class Recording {
 public:
  virtual ~Recording() = default;

  /// The next message; nothing at the end. What cannot be read is left out.
  virtual std::optional<Record> next() = 0;

  /// How far it has come, 0..1.
  virtual double progress() const = 0;

  /// Whether it knows when its scans were taken.
  virtual bool has_times() const { return true; }

  /// Why there was no scan, where it can say: "has no CLOUD; it holds LASER (4500)". At the end.
  virtual std::string why_no_scan() const { return {}; }

  /// How the table's rows are found. `poses` must outlive the answer.
  virtual RowOfScan match(const io::PoseTable& poses) const = 0;
};

/// Channels on which lasers speak for themselves.
using RawChannels = std::vector<std::string>;

/// Opens a folder of scans (scan_folder.h), what tcpdump recorded of a Velodyne laser, or an LCM
/// log, by its name or that of its parts. Of the log's channels those with this prefix are read.
/// Throws FileError when it is none of these. `omissions`
/// must outlive the recording. With `raw` channels, messages on them are raw records, and so are
/// the scans of a folder (on the only one of them), but for those that have ray origins: they were
/// put into base before.
std::unique_ptr<Recording> open_recording(const std::filesystem::path& path,
                                          const std::string& prefix, Omissions& omissions,
                                          const RawChannels& raw = {});

/// The three kinds. A laser's packets give raw records alone, on the only one of `raw`.
std::unique_ptr<Recording> open_folder_recording(const std::filesystem::path& folder,
                                                 Omissions& omissions, const RawChannels& raw = {});
std::unique_ptr<Recording> open_log_recording(const std::filesystem::path& log,
                                              const std::string& prefix, Omissions& omissions,
                                              const RawChannels& raw = {});
std::unique_ptr<Recording> open_pcap_recording(const std::filesystem::path& path,
                                               Omissions& omissions, const RawChannels& raw);

}  // namespace voxlist::desk
