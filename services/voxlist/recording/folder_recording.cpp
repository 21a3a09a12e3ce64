#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "services/voxlist/recording/recording.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/wire.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/scans/folder_events.h"

namespace voxlist::desk {
namespace {

// With a channel for each further column, as many as a message may have.
pointcloud_t to_raw_message(const io::RawScan& raw) {
  pointcloud_t message = bus::to_message(raw.cloud, "laser", 0);
  const auto n =
      std::min(raw.further.names.size(), static_cast<std::size_t>(bus::kMaxCloudChannels));
  message.n_channels = static_cast<std::int32_t>(n);
  message.channel_names.assign(raw.further.names.begin(),
                               raw.further.names.begin() + message.n_channels);
  message.channels.assign(raw.further.values.begin(),
                          raw.further.values.begin() + message.n_channels);
  return message;
}

class FolderRecording : public Recording {
 public:
  FolderRecording(const std::filesystem::path& folder, Omissions& omissions, std::string raw)
      : omissions_(omissions),
        raw_channel_(std::move(raw)),
        folder_(folder),
        events_(io::events_of(folder_)) {
    for (const std::string& note : folder_.file_notes()) omissions_.remark(note);
    tell(folder_.notes());
    if (events_.front().utime_us < 0) {
      throw io::FileError(folder,
                          "has times before 1970, which no log can hold; let them start at 0");
    }
  }

  std::optional<Record> next() override {
    while (next_ < events_.size()) {
      const io::FolderEvent& event = events_[next_];
      if (!event.is_scan) {
        ++next_;
        return odometry(event);
      }
      if (auto truth = untold_truth(event.number)) return truth;
      ++next_;
      if (auto cloud = read(event.number)) return cloud;
    }
    return std::nullopt;
  }

  double progress() const override {
    return static_cast<double>(next_) / static_cast<double>(events_.size());
  }

  bool has_times() const override { return folder_.has_times(); }

  RowOfScan match(const io::PoseTable& poses) const override {
    const io::RowMatch match = folder_.match(poses);
    tell(match.notes);
    return [rows = match.rows](std::int64_t number, std::int64_t) {
      return rows[static_cast<std::size_t>(number)];
    };
  }

 private:
  void tell(const std::vector<std::string>& notes) const {
    for (const std::string& note : notes) omissions_.remark("poses: " + note);
  }

  Record odometry(const io::FolderEvent& event) const {
    const io::PoseRow& row = folder_.odometry()->rows[event.number];
    return OdometryRecord{bus::to_message(StampedPose3{row.utime_us, row.pose})};
  }

  // Comes before its scan.
  std::optional<Record> untold_truth(std::size_t scan) {
    const auto truth = folder_.truth(scan);
    if (!truth || truths_told_ > scan) return std::nullopt;
    truths_told_ = scan + 1;
    return TruthRecord{bus::to_message(StampedPose3{folder_.utime_us(scan), *truth})};
  }

  std::optional<Record> read(std::size_t scan) {
    try {
      if (!raw_channel_.empty()) return read_raw(scan);
      return in_base(scan, folder_.read(scan));
    } catch (const io::FileError& error) {
      omissions_.add("unreadable", error.what());
      return std::nullopt;
    }
  }

  static Record in_base(std::size_t scan, const Cloud& cloud) {
    return CloudRecord{static_cast<std::int64_t>(scan),
                       bus::to_message(cloud, "base", static_cast<std::int32_t>(scan))};
  }

  std::optional<Record> read_raw(std::size_t scan) {
    const io::RawScan raw = folder_.read_raw(scan);
    if (!raw.cloud.origins.empty()) {
      omissions_.remark("scans with ray origins are taken as they are: they are in base already");
      return in_base(scan, folder_.read(scan));
    }
    RawRecord record{static_cast<std::int64_t>(scan), raw_channel_, {}};
    const bus::Fault fault = bus::encode(to_raw_message(raw), record.bytes);
    if (fault == bus::Fault::kNone) return record;
    omissions_.add(bus::fault_name(fault),
                   fmt::format("{}: its points make a message that is {}",
                               folder_.file(scan).string(), bus::fault_name(fault)));
    return std::nullopt;
  }

  Omissions& omissions_;
  const std::string raw_channel_;  // empty: scans are in base
  const io::ScanFolder folder_;
  const std::vector<io::FolderEvent> events_;
  std::size_t next_ = 0;
  std::size_t truths_told_ = 0;  // scans before this one
};

}  // namespace

std::unique_ptr<Recording> open_folder_recording(const std::filesystem::path& folder,
                                                 Omissions& omissions, const RawChannels& raw) {
  if (raw.size() > 1)
    throw io::FileError(folder, fmt::format("has the scans of one laser, but [cloud_adapter] has "
                                            "{} sensors: give settings with the one",
                                            raw.size()));
  return std::make_unique<FolderRecording>(folder, omissions, raw.empty() ? "" : raw.front());
}

}  // namespace voxlist::desk
