#include "voxlist/service/inputs/raw_cloud_input.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>

#include "voxlist/adapter/even_choice.h"

namespace voxlist::service {
namespace {

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

std::string why_refused(const bus::CloudView& message, const adapter::SensorConfig& sensor) {
  if (sensor.time_channel.empty()) return {};
  const auto& names = message.channel_names();
  const auto n = std::ranges::count(names, sensor.time_channel);
  if (n == 1) return {};
  return fmt::format("{} has {} channel \"{}\" (time_channel); it has: {}", sensor.channel,
                     n == 0 ? "no" : "more than one", sensor.time_channel, listed(names));
}

}  // namespace

RawCloudInput take_raw_cloud(const bus::CloudView& message, const adapter::SensorConfig& sensor) {
  RawCloudInput taken{std::nullopt, why_refused(message, sensor)};
  if (!taken.refusal.empty()) return taken;
  adapter::RawCloud& cloud = taken.cloud.emplace();
  cloud.utime_us = message.utime_us();
  cloud.all_rows = static_cast<std::uint32_t>(message.size());
  const auto& names = message.channel_names();
  const auto time_channel =
      static_cast<std::size_t>(std::ranges::find(names, sensor.time_channel) - names.begin());
  const auto at_most = static_cast<std::size_t>(sensor.max_points);
  cloud.points.reserve(std::min(at_most + at_most / 64, message.size()));
  const adapter::EvenChoice choice(message.size(), at_most);
  for (std::size_t i = 0; i < message.size(); ++i) {
    if (!choice.keeps(i)) continue;
    cloud.points.push_back(message.point(i));
    cloud.rows.push_back(static_cast<std::uint32_t>(i));
    if (time_channel < names.size()) cloud.times.push_back(message.value(time_channel, i));
  }
  return taken;
}

}  // namespace voxlist::service
