#include "voxlist/adapter/point_times.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"
#include "voxlist/system/check.h"

namespace voxlist::adapter {
namespace {

constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();

double seconds_of(TimeUnit unit) {
  switch (unit) {
    case TimeUnit::kSeconds:
      return 1.0;
    case TimeUnit::kMilliseconds:
      return 1e-3;
    case TimeUnit::kMicroseconds:
      return 1e-6;
    case TimeUnit::kNanoseconds:
      return 1e-9;
  }
  return 1.0;
}

std::vector<double> told_times(const RawCloud& raw, TimeUnit unit) {
  const double unit_s = seconds_of(unit);
  std::vector<double> times_s;
  times_s.reserve(raw.times.size());
  for (const float time : raw.times)
    times_s.push_back(std::isfinite(time) ? static_cast<double>(time) * unit_s : kNoTime);
  return times_s;
}

// How much of its turn the laser had done when it measured a point, 0 to 1.
double turned_share(const Eigen::Vector3f& point, const SensorConfig& sensor) {
  const double azimuth_rad =
      elementary::atan2(static_cast<double>(point.y()), static_cast<double>(point.x()));
  const double turned = (azimuth_rad - sensor.sweep_start_deg * kRadPerDeg) / kTurn_rad;
  const double forward = sensor.sweep_order == SweepOrder::kClockwise ? -turned : turned;
  return forward - std::floor(forward);
}

std::vector<double> even_times(const RawCloud& raw, const SensorConfig& sensor) {
  const bool by_row = sensor.sweep_order == SweepOrder::kRows;
  const double steps = std::max(1.0, static_cast<double>(raw.all_rows) - 1.0);
  std::vector<double> times_s;
  times_s.reserve(raw.points.size());
  for (std::size_t i = 0; i < raw.points.size(); ++i) {
    const double share = by_row ? raw.rows[i] / steps : turned_share(raw.points[i], sensor);
    times_s.push_back(share * sensor.sweep_ms * 1e-3);
  }
  return times_s;
}

// The time that utime is of, in the counting of the points' times.
double utime_s(UtimeOf utime_of, double first_s, double last_s) {
  switch (utime_of) {
    case UtimeOf::kTimeZero:
      return 0.0;
    case UtimeOf::kFirst:
      return first_s;
    case UtimeOf::kMiddle:
      return 0.5 * (first_s + last_s);
    case UtimeOf::kLast:
      return last_s;
  }
  return 0.0;
}

// NaN sorts nowhere: it is left out.
std::pair<double, double> ends(const std::vector<double>& times_s) {
  double first_s = std::numeric_limits<double>::infinity(), last_s = -first_s;
  for (const double time_s : times_s) {
    first_s = time_s < first_s ? time_s : first_s;
    last_s = time_s > last_s ? time_s : last_s;
  }
  return {first_s, last_s};
}

void judge(PointTimes& times) {
  const double span_s = times.last_s - times.first_s;
  const double reach_s = std::max(std::abs(times.first_s), std::abs(times.last_s));
  times.is_refused = !(span_s <= kMaxOffset_s) || !(reach_s <= kMaxOffset_s);
  if (!(span_s <= kMaxOffset_s)) {
    times.complaint =
        fmt::format("the points' times are {:.3g} s apart: is time_unit right?", span_s);
  } else if (!(reach_s <= kMaxOffset_s)) {
    times.complaint = fmt::format(
        "the points' times are {:.3g} s from utime: set utime_of, which says what they count from",
        reach_s);
  } else if (span_s == 0.0 && times.offsets_s.size() > 1) {
    times.complaint =
        "all points have one time, and are not de-skewed: is it absolute, which 32 bits cannot "
        "hold?";
  }
}

}  // namespace

PointTimes point_times(const RawCloud& raw, const SensorConfig& sensor) {
  PointTimes result;
  if (!sensor.has_times() || raw.points.empty()) return result;
  VOXLIST_CHECK(sensor.time_channel.empty() ? raw.rows.size() == raw.points.size()
                                            : raw.times.size() == raw.points.size(),
                "one time or one row a point");
  const std::vector<double> times_s =
      sensor.time_channel.empty() ? even_times(raw, sensor) : told_times(raw, sensor.time_unit);
  auto [first_s, last_s] = ends(times_s);
  if (last_s < first_s) {
    result.complaint = "no point has a time: they are not finite";
    result.is_refused = true;
    return result;
  }
  if (sensor.time_channel.empty()) first_s = 0.0, last_s = sensor.sweep_ms * 1e-3;
  const double zero_s = utime_s(sensor.utime_of, first_s, last_s);
  result.first_s = first_s - zero_s;
  result.last_s = last_s - zero_s;
  for (const double time_s : times_s)
    result.offsets_s.push_back(static_cast<float>(time_s - zero_s));
  judge(result);
  return result;
}

}  // namespace voxlist::adapter
