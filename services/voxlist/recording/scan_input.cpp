#include "services/voxlist/recording/scan_input.h"

#include <fmt/core.h>

#include <utility>

#include "services/voxlist/output/stop.h"
#include "voxlist/bus/convert.h"
#include "voxlist/io/files/file.h"

namespace voxlist::desk {

ScanInput::ScanInput(std::filesystem::path path, Console& console)
    : path_(std::move(path)), omissions_(console), recording_(open_recording(path_, omissions_)) {}

std::optional<Scan> ScanInput::next() {
  while (!stop_requested()) {
    auto record = recording_->next();
    if (!record) break;
    auto scan = std::visit([this](auto& message) { return take(message); }, *record);
    if (scan) return scan;
  }
  if (scans_ > 0) return std::nullopt;
  throw io::FileError(path_, stop_requested()
                                 ? "interrupted before the first scan, nothing was written"
                                 : "has no scan that can be read, give a folder of scans or a log");
}

std::optional<Scan> ScanInput::take(CloudRecord& record) {
  bus::ReceivedCloud received = bus::from_message(record.message);
  if (!received.cloud) {
    const std::string reason = "CLOUD/" + received.refusal;
    omissions_.add(reason, fmt::format("scan {}: {}", record.number, reason));
    return std::nullopt;
  }
  last_us_ = received.cloud->utime_us;
  if (scans_++ == 0) first_us_ = last_us_;
  return Scan{record.number, std::move(*received.cloud), odometry_.at(last_us_)};
}

std::optional<Scan> ScanInput::take(const OdometryRecord& record) {
  if (const auto pose = bus::from_message(record.message)) {
    odometry_.add({pose->utime_us, to_pose2(pose->pose)});
  } else {
    omissions_.add("ODOMETRY/bad_pose", "an ODOMETRY that is no pose");
  }
  return std::nullopt;
}

}  // namespace voxlist::desk
