#include "services/voxlist/scanner_log.h"

#include <algorithm>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pose_t.hpp>

#include "bus/convert.h"
#include "bus/event_log.h"
#include "io/file.h"
#include "services/voxlist/omissions.h"
#include "services/voxlist/progress.h"

namespace voxlist {
namespace {

constexpr std::size_t kMostLines = 10 * 60 * 75;

// Nothing when the message is damaged or forged.
template <class M>
auto read(const Event& event, Omissions& omissions) -> decltype(from_message(M())) {
  const auto leave_out = [&](const std::string& why) {
    omissions.add(event.channel + "/" + why,
                  event.channel + " in event " + std::to_string(event.number) + " is " + why);
  };
  M message;
  if (const Fault fault = decode(event.bytes, message); fault != Fault::kNone) {
    leave_out(fault_name(fault));
    return std::nullopt;
  }
  auto value = from_message(message);
  if (!value) leave_out("refused");
  return value;
}

void take(const Event& event, Omissions& omissions, CalibrationInput& input) {
  if (event.channel == kLaser.name) {
    if (auto line = read<planar_lidar_t>(event, omissions)) input.lines.push_back(std::move(*line));
  } else if (event.channel == kMirror.name) {
    if (auto state = read<mirror_state_t>(event, omissions))
      input.mirror.push_back(std::move(*state));
  } else if (event.channel == kOdometry.name) {
    if (const auto pose = read<pose_t>(event, omissions))
      input.odometry.push_back({pose->utime_us, to_pose2(pose->pose)});
  }
}

void sort_by_time(CalibrationInput& input) {
  std::ranges::stable_sort(input.lines, {}, &LaserLine::utime_us);
  std::ranges::stable_sort(input.mirror, {}, &MirrorState::utime_us);
  std::ranges::stable_sort(input.odometry, {}, &StampedPose2::utime_us);
}

}  // namespace

CalibrationInput read_scanner_log(const std::filesystem::path& path, Console& console) {
  EventLogReader log(path.string());
  Omissions omissions(console);
  Progress progress(console, "reading");
  CalibrationInput input;
  while (input.lines.size() < kMostLines) {
    const auto event = log.next();
    if (!event) break;
    take(*event, omissions, input);
    progress.show(static_cast<double>(log.position_bytes()) /
                  static_cast<double>(log.size_bytes()));
  }
  if (input.lines.empty()) {
    throw FileError(path, std::string("has no ") + kLaser.name +
                              ", record a minute with lcm-logger while the scanner runs");
  }
  if (input.lines.size() == kMostLines) console.warn("the first ten minutes are enough");
  if (log.damaged_events() > 0) omissions.add("damaged events", path.string() + " is damaged");
  if (!omissions.empty()) console.warn("left out: " + omissions.summary());
  sort_by_time(input);
  return input;
}

}  // namespace voxlist
