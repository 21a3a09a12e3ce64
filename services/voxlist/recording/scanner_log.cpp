#include "services/voxlist/recording/scanner_log.h"

#include <fmt/core.h>

#include <algorithm>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/voxlist/output/progress.h"
#include "services/voxlist/recording/channel_counts.h"
#include "services/voxlist/recording/omissions.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/event_log.h"
#include "voxlist/io/files/file.h"

namespace voxlist::desk {
namespace {

// Lines that are taken of a log: ten minutes at 75 a second. Calibration needs one minute.
constexpr std::size_t kMostLines = 10 * 60 * 75;

// Nothing when the message is damaged or forged.
template <class M>
auto read(const bus::Event& event, Omissions& omissions) -> decltype(bus::from_message(M())) {
  const auto leave_out = [&](const std::string& why) {
    omissions.add(fmt::format("{}/{}", event.channel, why),
                  fmt::format("{} in event {} is {}", event.channel, event.number, why));
  };
  M message;
  if (const bus::Fault fault = bus::decode(event.bytes, message); fault != bus::Fault::kNone) {
    leave_out(bus::fault_name(fault));
    return std::nullopt;
  }
  auto value = bus::from_message(message);
  if (!value) leave_out("refused");
  return value;
}

void take(const bus::Event& event, Omissions& omissions, calibration::CalibrationInput& input) {
  if (event.channel == bus::kLaser.name) {
    if (auto line = read<planar_lidar_t>(event, omissions)) input.lines.push_back(std::move(*line));
  } else if (event.channel == bus::kMirror.name) {
    if (auto state = read<mirror_state_t>(event, omissions))
      input.mirror.push_back(std::move(*state));
  } else if (event.channel == bus::kOdometry.name) {
    if (const auto pose = read<pose_t>(event, omissions))
      input.odometry.push_back({pose->utime_us, to_pose2(pose->pose)});
  }
}

void sort_by_time(calibration::CalibrationInput& input) {
  std::ranges::stable_sort(input.lines, {}, &LaserLine::utime_us);
  std::ranges::stable_sort(input.mirror, {}, &MirrorState::utime_us);
  std::ranges::stable_sort(input.odometry, {}, &StampedPose2::utime_us);
}

}  // namespace

calibration::CalibrationInput read_scanner_log(const std::filesystem::path& path,
                                               const std::string& prefix, Console& console) {
  bus::EventLogReader log(path.string());
  Omissions omissions(console);
  ChannelCounts channels;
  Progress progress(console, "reading");
  calibration::CalibrationInput input;
  for (const std::string& part : log.missing_parts())
    omissions.add("missing parts", part + " is not there");
  while (input.lines.size() < kMostLines) {
    auto event = log.next();
    if (!event) break;
    channels.add(event->channel);
    if (!event->channel.starts_with(prefix)) continue;
    event->channel.erase(0, prefix.size());
    take(*event, omissions, input);
    progress.show(static_cast<double>(log.position_bytes()) /
                  static_cast<double>(log.size_bytes()));
  }
  if (input.lines.empty()) {
    throw io::FileError(path, channels.why_without(bus::kLaser.name, prefix,
                                                   ". Record a minute while the scanner runs"));
  }
  if (input.lines.size() == kMostLines) console.warn("the first ten minutes are enough");
  if (log.damaged_events() > 0) omissions.add("damaged events", path.string() + " is damaged");
  if (!omissions.empty()) console.warn("left out: " + omissions.summary());
  sort_by_time(input);
  return input;
}

}  // namespace voxlist::desk
