#include "services/voxlist/recording/scan_input.h"

#include <fmt/core.h>

#include <utility>

#include "services/voxlist/output/stop.h"
#include "services/voxlist/recording/adapted_recording.h"
#include "voxlist/bus/convert.h"
#include "voxlist/geometry/time_limit.h"
#include "voxlist/io/files/file.h"

namespace voxlist::desk {
namespace {

std::unique_ptr<Recording> open(const std::filesystem::path& path, const std::string& prefix,
                                const adapter::AdapterConfig& adapter, Omissions& omissions) {
  auto recording = open_recording(path, prefix, omissions, channels_of(adapter));
  if (adapter.sensors.empty()) return recording;
  return adapted(std::move(recording), adapter, omissions);
}

}  // namespace

ScanInput::ScanInput(std::filesystem::path path, Console& console, const RangeLimits& limits,
                     const std::string& prefix, const adapter::AdapterConfig& adapter)
    : path_(std::move(path)),
      omissions_(console),
      recording_(open(path_, prefix, adapter, omissions_)),
      limits_(limits),
      times_(path_, omissions_) {}

std::optional<Scan> ScanInput::next() {
  while (!stop_requested()) {
    auto record = recording_->next();
    if (!record) break;
    auto scan = std::visit([this](auto& message) { return take(message); }, *record);
    if (scan) return scan;
  }
  if (!stop_requested()) times_.check_at_end();
  if (scans() == 0) refuse_all();
  return std::nullopt;
}

void ScanInput::refuse_all() const {
  if (stop_requested())
    throw io::FileError(path_, "interrupted before the first scan, nothing was written");
  const std::string why = recording_->why_no_scan();
  throw io::FileError(path_, why.empty()
                                 ? "has no scan that can be read, give a folder of scans or "
                                   "a log"
                                 : why);
}

std::optional<Scan> ScanInput::take(CloudRecord& record) {
  const std::int64_t utime_us = record.message.utime;
  bus::ReceivedCloud received = bus::from_message(record.message);
  if (!received.cloud && utime_us < kMaxUtime_us) {
    const std::string reason = "CLOUD/" + received.refusal;
    omissions_.add(reason, fmt::format("scan {}: {}", record.number, reason));
    return std::nullopt;
  }
  if (!times_.take(record.number, utime_us)) return std::nullopt;
  remark_on_points(record.number, record.message, *received.cloud, limits_, omissions_);
  return Scan{record.number, std::move(*received.cloud), odometry_.at(utime_us),
              odometry_.tilt_at(utime_us)};
}

std::optional<Scan> ScanInput::take(const OdometryRecord& record) {
  if (const auto pose = bus::from_message(record.message)) {
    odometry_.add({pose->utime_us, to_pose2(pose->pose)}, tilt_of(pose->pose));
  } else {
    omissions_.add("ODOMETRY/bad_pose", "an ODOMETRY that is no pose");
  }
  return std::nullopt;
}

}  // namespace voxlist::desk
