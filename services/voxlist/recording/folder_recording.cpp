#include "services/voxlist/recording/recording.h"
#include "voxlist/bus/convert.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/scans/folder_events.h"

namespace voxlist::desk {
namespace {

class FolderRecording : public Recording {
 public:
  FolderRecording(const std::filesystem::path& folder, Omissions& omissions)
      : omissions_(omissions), folder_(folder), events_(io::events_of(folder_)) {
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
      const Cloud cloud = folder_.read(scan);
      return CloudRecord{static_cast<std::int64_t>(scan),
                         bus::to_message(cloud, "base", static_cast<std::int32_t>(scan))};
    } catch (const io::FileError& error) {
      omissions_.add("unreadable", error.what());
      return std::nullopt;
    }
  }

  Omissions& omissions_;
  const io::ScanFolder folder_;
  const std::vector<io::FolderEvent> events_;
  std::size_t next_ = 0;
  std::size_t truths_told_ = 0;  // scans before this one
};

}  // namespace

std::unique_ptr<Recording> open_folder_recording(const std::filesystem::path& folder,
                                                 Omissions& omissions) {
  return std::make_unique<FolderRecording>(folder, omissions);
}

}  // namespace voxlist::desk
