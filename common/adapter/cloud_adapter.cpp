#include "voxlist/adapter/cloud_adapter.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "voxlist/adapter/deskew.h"
#include "voxlist/system/check.h"

namespace voxlist::adapter {
namespace {

// Clouds that may wait for odometry: at 10 Hz, more than max_wait_ms allows.
constexpr std::size_t kMostWaiting = 20;

// A time so much (us) before a sensor's last means that time started anew: a log is played again.
constexpr std::int64_t kStartsAnew_us = 1'000'000;

std::int64_t to_us(double ms) { return std::llround(ms * 1e3); }

void check(const SensorConfig& sensor) {
  if (sensor.channel.empty()) throw std::invalid_argument("sensor.channel must be set");
  if (!sensor.time_channel.empty() && sensor.sweep_ms > 0.0)
    throw std::invalid_argument("sensor.sweep_ms is for lasers without time_channel: set one");
}

const AdapterConfig& checked(const AdapterConfig& config) {
  if (config.sensors.empty())
    throw std::invalid_argument("no sensor: each needs a table [[cloud_adapter.sensor]]");
  std::set<std::string> channels{"CLOUD", "CLOUD_SLICE", "ODOMETRY"};
  for (const SensorConfig& sensor : config.sensors) {
    check(sensor);
    if (!channels.insert(sensor.channel).second)
      throw std::invalid_argument("sensor.channel \"" + sensor.channel +
                                  "\" is taken: each sensor needs a channel of its own");
  }
  if (config.level && !config.use_odometry)
    throw std::invalid_argument("level needs use_odometry: ODOMETRY tells roll and pitch");
  return config;
}

bool any_needs_odometry(const AdapterConfig& config) {
  const bool moves =
      config.sensors.size() > 1 || std::ranges::any_of(config.sensors, &SensorConfig::has_times);
  return config.use_odometry && (config.level || moves);
}

}  // namespace

CloudAdapter::CloudAdapter(const AdapterConfig& config)
    : config_(checked(config)),
      robot_(config.robot_boxes_m, "robot_boxes_m"),
      needs_odometry_(any_needs_odometry(config)),
      rate_(config.max_rate_hz) {
  for (const SensorConfig& sensor : config.sensors)
    sensors_.push_back({SensorPoints(sensor), {}, {}, false});
}

Adapted CloudAdapter::add_cloud(std::size_t sensor, RawCloud raw) {
  VOXLIST_CHECK(sensor < sensors_.size(), "a sensor of the settings");
  Adapted out = start();
  if (auto sweep = judge(sensor, std::move(raw), out)) take(std::move(*sweep), out);
  advance(out);
  return out;
}

Adapted CloudAdapter::add_odometry(const StampedPose3& T_odom_base) {
  Adapted out = start();
  motion_.add(T_odom_base);
  newest_us_ = std::max(newest_us_, T_odom_base.utime_us);
  advance(out);
  return out;
}

Adapted CloudAdapter::finish() {
  Adapted out = start();
  if (waiting_.empty()) return out;
  newest_us_ = waiting_.back().last_us + to_us(config_.max_wait_ms) + 1;
  advance(out);
  return out;
}

Adapted CloudAdapter::start() const {
  Adapted out;
  out.sensors.resize(sensors_.size());
  return out;
}

void CloudAdapter::start_anew() {
  for (Sensor& sensor : sensors_) {
    sensor.newest.reset();
    sensor.last_us.reset();
  }
  waiting_.clear();
  newest_us_ = 0;
  start_us_.reset();
}

std::optional<CloudAdapter::Sweep> CloudAdapter::judge(std::size_t sensor, RawCloud raw,
                                                       Adapted& out) {
  SensorReport& report = out.sensors[sensor];
  Sweep sweep{sensor, std::move(raw), {}, 0};
  sweep.times = point_times(sweep.raw, config_.sensors[sensor]);
  report.time_complaint = sweep.times.complaint;
  if (sweep.times.is_refused) {
    ++report[MessageFate::kBadTimes];
    return std::nullopt;
  }
  sweep.last_us = sweep.raw.utime_us - to_us(config_.sensors[sensor].latency_ms) +
                  to_us(sweep.times.last_s * 1e3);
  const auto& last_us = sensors_[sensor].last_us;
  if (last_us && *last_us - sweep.last_us > kStartsAnew_us) start_anew();
  if (last_us && sweep.last_us <= *last_us) {
    ++report[MessageFate::kOutOfOrder];
    return std::nullopt;
  }
  return sweep;
}

void CloudAdapter::take(Sweep sweep, Adapted& out) {
  Sensor& sensor = sensors_[sweep.sensor];
  const std::int64_t now_us = sweep.last_us;
  newest_us_ = std::max(newest_us_, now_us);
  if (!start_us_) start_us_ = now_us;
  sensor.last_us = now_us;
  sensor.is_absent = false;
  if (config_.slices) wait({sweep}, true, out);
  if (sensor.newest) ++out.sensors[sweep.sensor][MessageFate::kSuperseded];
  sensor.newest = std::move(sweep);
  if (is_complete() || is_overdue(now_us)) join(now_us, out);
}

bool CloudAdapter::is_complete() const {
  return std::ranges::all_of(sensors_, [](const Sensor& s) { return s.newest || s.is_absent; });
}

// Whether a sensor's message has waited too long for the others'. A sensor without any for so long
// is absent.
bool CloudAdapter::is_overdue(std::int64_t now_us) const {
  return std::ranges::any_of(sensors_, [&](const Sensor& s) {
    return !s.newest && now_us - s.last_us.value_or(*start_us_) > to_us(config_.join_wait_ms);
  });
}

void CloudAdapter::join(std::int64_t now_us, Adapted& out) {
  if (!rate_.lets(now_us)) return;
  std::vector<Sweep> sweeps;
  for (Sensor& sensor : sensors_) {
    sensor.is_absent = !sensor.newest;
    if (sensor.newest) sweeps.push_back(std::move(*sensor.newest));
    sensor.newest.reset();
  }
  out.incomplete += sweeps.size() < sensors_.size();
  wait(std::move(sweeps), false, out);
}

void CloudAdapter::wait(std::vector<Sweep> sweeps, bool is_slice, Adapted& out) {
  const Sweep& latest = *std::ranges::max_element(sweeps, {}, &Sweep::last_us);
  const std::int64_t last_us = latest.last_us, number = latest.raw.number;
  waiting_.push_back({std::move(sweeps), last_us, number, is_slice});
  if (waiting_.size() <= kMostWaiting) return;
  for (const Sweep& sweep : waiting_.front().sweeps)
    ++out.sensors[sweep.sensor][MessageFate::kOverflow];
  waiting_.pop_front();
}

void CloudAdapter::advance(Adapted& out) {
  while (!waiting_.empty()) {
    const Waiting& first = waiting_.front();
    const bool is_known = !needs_odometry_ || knows(first.last_us);
    if (!is_known && newest_us_ - first.last_us <= to_us(config_.max_wait_ms)) return;
    if (auto cloud = make(first, out)) {
      (first.is_slice ? out.slices : out.clouds).push_back(std::move(*cloud));
      if (!first.is_slice) out.numbers.push_back(first.number);
    }
    waiting_.pop_front();
  }
}

bool CloudAdapter::knows(std::int64_t utime_us) const {
  return motion_.at(utime_us, to_us(config_.odometry_extrapolation_ms)).has_value();
}

std::optional<Cloud> CloudAdapter::make(const Waiting& waiting, Adapted& out) const {
  std::optional<Pose3> T_out_odom;
  if (needs_odometry_) {
    T_out_odom = motion_.at(waiting.last_us, to_us(config_.odometry_extrapolation_ms));
    if (T_out_odom && config_.level) T_out_odom = levelled(*T_out_odom);
    if (T_out_odom) T_out_odom = T_out_odom->inverse();
  }
  Cloud cloud;
  cloud.utime_us = waiting.last_us;
  bool all = true;
  for (const Sweep& sweep : waiting.sweeps) {
    // A slice's points come again in its CLOUD, and are counted there.
    SensorReport again;
    SensorReport& report = waiting.is_slice ? again : out.sensors[sweep.sensor];
    all &= add(sweep, T_out_odom ? &*T_out_odom : nullptr, cloud, report);
  }
  if (!all || cloud.points.empty()) return std::nullopt;
  return cloud;
}

bool CloudAdapter::add(const Sweep& sweep, const Pose3* T_out_odom, Cloud& cloud,
                       SensorReport& report) const {
  const TimedPoints points = sensors_[sweep.sensor].points.place(sweep.raw, sweep.times, robot_);
  for (std::size_t i = 0; i < kPointFates; ++i) report.points[i] += points.counts[i];
  bool is_known = true;
  if (!needs_odometry_)
    add_standing(points, cloud);
  else
    is_known =
        T_out_odom != nullptr &&
        add_moved(points, motion_, to_us(config_.odometry_extrapolation_ms), *T_out_odom, cloud);
  ++report[!is_known               ? MessageFate::kNoOdometry
           : points.points.empty() ? MessageFate::kNoPoints
                                   : MessageFate::kUsed];
  return is_known;
}

}  // namespace voxlist::adapter
