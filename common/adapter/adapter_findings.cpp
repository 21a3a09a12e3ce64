#include "voxlist/adapter/adapter_findings.h"

#include <fmt/core.h>

#include <numeric>

namespace voxlist::adapter {
namespace {

// A mount or boxes that are wrong make the robot's body eat more than this share of a sweep.
constexpr double kMostOnRobot = 0.9;

std::int64_t count(const SensorReport& report, PointFate fate) {
  return report.points[static_cast<std::size_t>(fate)];
}

double share(std::int64_t part, std::int64_t all) {
  return static_cast<double>(part) / static_cast<double>(all);
}

std::string why_none_is_left(const SensorReport& report, const std::string& channel) {
  return fmt::format(
      "no point of {} is left: {} are 0,0,0 or not finite, {} nearer than range_min_m, {} farther "
      "than range_max_m, {} on the robot (robot_boxes_m), {} without a time",
      channel, count(report, PointFate::kNoReturn), count(report, PointFate::kTooNear),
      count(report, PointFate::kTooFar), count(report, PointFate::kRobot),
      count(report, PointFate::kNoTime));
}

}  // namespace

std::vector<AdapterFinding> findings(const SensorReport& report, const std::string& channel) {
  std::vector<AdapterFinding> found;
  if (!report.time_complaint.empty())
    found.push_back({"point_times", fmt::format("{}: {}", channel, report.time_complaint),
                     report[MessageFate::kBadTimes] > 0 ? Grade::kError : Grade::kWarning});
  if (report[MessageFate::kNoPoints] > 0)
    found.push_back({"no_points", why_none_is_left(report, channel), Grade::kError});
  const std::int64_t on_robot = count(report, PointFate::kRobot),
                     in_range = on_robot + count(report, PointFate::kPoint);
  if (in_range > 0 && share(on_robot, in_range) > kMostOnRobot)
    found.push_back({"robot", fmt::format("robot_boxes_m hold {:.0f} % of {}'s points: are its "
                                          "mount and the boxes right?",
                                          100.0 * share(on_robot, in_range), channel)});
  if (report[MessageFate::kNoOdometry] > 0)
    found.push_back({"no_odometry",
                     fmt::format("{} waits for ODOMETRY in vain: does it come, and do their clocks "
                                 "agree? Without one set use_odometry = false",
                                 channel),
                     Grade::kError});
  if (report[MessageFate::kSuperseded] > 0)
    found.push_back({"rate",
                     fmt::format("{} comes faster than CLOUD may (max_rate_hz): the newest are "
                                 "taken",
                                 channel),
                     Grade::kNote});
  return found;
}

}  // namespace voxlist::adapter
