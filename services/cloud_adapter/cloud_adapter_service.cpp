#include "services/cloud_adapter/cloud_adapter_service.h"

#include <fmt/core.h>

#include <cctype>
#include <stdexcept>
#include <utility>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/adapter/adapter_findings.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/cloud_view.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/service/inputs/raw_cloud_input.h"

namespace voxlist::services {
namespace {

using State = bus::Health::State;

// The bus refuses other names when it is too late to say it kindly.
const adapter::AdapterConfig& with_plain_names(const adapter::AdapterConfig& config) {
  for (const adapter::SensorConfig& sensor : config.sensors)
    for (const char c : sensor.channel)
      if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-' && c != '/')
        throw std::invalid_argument("sensor.channel \"" + sensor.channel +
                                    "\" may only hold letters, digits, _ - and /");
  return config;
}

State state_of(adapter::Grade grade) {
  switch (grade) {
    case adapter::Grade::kNote:
      return State::kOk;
    case adapter::Grade::kWarning:
      return State::kWarning;
    case adapter::Grade::kError:
      break;
  }
  return State::kError;
}

}  // namespace

CloudAdapterService::CloudAdapterService(bus::Bus& bus, bus::Health& health,
                                         const adapter::AdapterConfig& config)
    : bus_(bus),
      health_(health),
      config_(with_plain_names(config)),
      adapter_(config_),
      odometry_(health,
                {.channel = bus::kOdometry.name,
                 .remedy = "is the robot base running? Without one set use_odometry = false",
                 .disorder_us = OdometryBuffer::kMaxAge_us}),
      clouds_(health, {.channel = bus::kCloud.name, .remedy = ""}),
      superseded_(config.sensors.size()) {
  for (std::size_t i = 0; i < config_.sensors.size(); ++i) {
    const bus::Channel<pointcloud_t> channel{config_.sensors[i].channel.c_str()};
    sensors_.emplace_back(health, service::ChannelCheck::Options{
                                      .channel = channel.name, .remedy = "is its driver running?"});
    bus_.subscribe_bytes(
        channel, [this, i](bus::Bytes bytes) { take_cloud(i, bytes); }, bus::Delivery::kLatest);
  }
  if (adapter_.needs_odometry())
    bus_.subscribe(bus::kOdometry, [this](const pose_t& m) { take_odometry(m); });
}

void CloudAdapterService::check(const adapter::AdapterConfig& config) {
  adapter::CloudAdapter{with_plain_names(config)};
}

void CloudAdapterService::take_cloud(std::size_t sensor, bus::Bytes bytes) {
  const bus::CloudView message(bytes);
  service::ChannelCheck& check = sensors_[sensor];
  const std::int64_t skipped = newly_superseded(sensor);
  check.take_number(message.seq(), skipped);
  check.leave_out(skipped);
  if (!check.take(message.utime_us())) return;
  auto raw = service::take_raw_cloud(message, config_.sensors[sensor]);
  if (!raw.cloud) {
    health_.count(config_.sensors[sensor].channel + "/no_time_channel");
    return check.note("no_time_channel", State::kError, raw.refusal);
  }
  arrival_us_ = bus_.arrival_utime_us();
  publish(adapter_.add_cloud(sensor, std::move(*raw.cloud)));
}

// Messages since the last one that this one took the place of.
std::int64_t CloudAdapterService::newly_superseded(std::size_t sensor) {
  const auto counted = bus_.counters().find(config_.sensors[sensor].channel + "/superseded");
  const std::int64_t all = counted == bus_.counters().end() ? 0 : counted->second;
  return all - std::exchange(superseded_[sensor], all);
}

void CloudAdapterService::take_odometry(const pose_t& message) {
  if (!odometry_.take(message.utime)) return;
  const auto pose = bus::from_message(message);
  if (!pose) return health_.count("ODOMETRY/not_a_pose");
  publish(adapter_.add_odometry(*pose));
}

void CloudAdapterService::publish(const adapter::Adapted& adapted) {
  // Slices of several sensors do not stand for each other.
  const auto slices = sensors_.size() > 1 ? bus::Delivery::kEvery : bus::Delivery::kLatest;
  for (const Cloud& slice : adapted.slices)
    bus_.publish(bus::kCloudSlice, bus::to_message(slice, "base", slices_sent_++), slices);
  for (const Cloud& cloud : adapted.clouds) {
    bus_.publish(bus::kCloud, bus::to_message(cloud, "base", clouds_sent_++),
                 bus::Delivery::kLatest);
    sent_arrival_us_ = arrival_us_;
    health_.gauge("cloud_points", static_cast<double>(cloud.points.size()));
  }
  tell(adapted);
}

void CloudAdapterService::tell(const adapter::Adapted& adapted) {
  for (std::size_t i = 0; i < adapted.sensors.size(); ++i) tell(i, adapted.sensors[i]);
  if (adapted.incomplete == 0) return;
  health_.count("CLOUD/incomplete", adapted.incomplete);
  clouds_.note("incomplete", State::kWarning,
               "CLOUD goes out without some of the sensors: does each speak within join_wait_ms?");
}

void CloudAdapterService::tell(std::size_t sensor, const adapter::SensorReport& report) {
  const std::string& channel = config_.sensors[sensor].channel;
  for (std::size_t i = 0; i < adapter::kMessageFates; ++i)
    if (report.messages[i] > 0)
      health_.count(channel + '/' + adapter::counter_name(static_cast<adapter::MessageFate>(i)),
                    report.messages[i]);
  for (std::size_t i = 0; i < adapter::kPointFates; ++i)
    if (report.points[i] > 0)
      health_.count(
          channel + "/points/" + adapter::counter_name(static_cast<adapter::PointFate>(i)),
          report.points[i]);
  for (const adapter::AdapterFinding& finding : adapter::findings(report, channel))
    sensors_[sensor].note(finding.key, state_of(finding.grade), finding.sentence);
}

void CloudAdapterService::tick(std::int64_t now_us) {
  for (service::ChannelCheck& sensor : sensors_) sensor.tick(now_us);
  if (adapter_.needs_odometry()) odometry_.tick(now_us);
  clouds_.tick(now_us);
  if (sent_arrival_us_) health_.add_latency_us(now_us - *sent_arrival_us_);
  sent_arrival_us_.reset();
}

}  // namespace voxlist::services
