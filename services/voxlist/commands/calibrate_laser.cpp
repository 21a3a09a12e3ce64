#include <fmt/core.h>

#include <algorithm>

#include "services/voxlist/commands/calibrate.h"
#include "services/voxlist/maps/laser_calibration.h"
#include "voxlist/config/edit.h"
#include "voxlist/io/files/file.h"

namespace voxlist::desk {
namespace {

using adapter::SensorConfig;

std::size_t sensor_of(const CalibrateOptions& options, const adapter::AdapterConfig& config) {
  const std::string file = options.settings().string();
  if (config.sensors.empty())
    throw io::FileError(file.empty() ? "--config" : file,
                        "has no [[cloud_adapter.sensor]]: write one, with its channel, its "
                        "time_channel, and roll and pitch to 20 deg");
  if (options.channel.empty() && config.sensors.size() == 1) return 0;
  const auto found = std::ranges::find(config.sensors, options.channel, &SensorConfig::channel);
  if (found == config.sensors.end())
    throw io::FileError(file, options.channel.empty()
                                  ? "has several sensors: name one of them (--channel)"
                                  : "has no sensor with the channel " + options.channel);
  return static_cast<std::size_t>(found - config.sensors.begin());
}

std::string told(const LaserParameter& parameter, double value) {
  return fmt::format("{:.{}f}", value, parameter.decimals);
}

void tell(const LaserCalibration& result, Console& console) {
  console.say(fmt::format("{:18}{:>12}{:>12}{:>12}", "parameter", "before", "after", "sd"));
  for (std::size_t i = 0; i < kLaserParameters.size(); ++i) {
    const LaserParameter& parameter = kLaserParameters[i];
    console.say(fmt::format("{:18}{:>12}{:>12}{:>12}", parameter.key,
                            told(parameter, result.before.*parameter.value),
                            told(parameter, result.after.*parameter.value),
                            result.sd[i] ? told(parameter, *result.sd[i]) : "held"));
  }
  console.say(fmt::format("{} of {} scans placed, {} motions compared with ODOMETRY", result.placed,
                          result.scans, result.motions));
}

std::vector<std::pair<std::string, std::string>> values_of(const LaserCalibration& result) {
  std::vector<std::pair<std::string, std::string>> values;
  for (std::size_t i = 0; i < kLaserParameters.size(); ++i)
    if (result.sd[i])
      values.emplace_back(kLaserParameters[i].key,
                          told(kLaserParameters[i], result.after.*kLaserParameters[i].value));
  return values;
}

}  // namespace

int calibrate_laser(const CalibrateOptions& options, Console& console) {
  DeskSettings settings = read_settings(options.settings());
  const std::size_t number = sensor_of(options, settings.adapter);
  settings.adapter.sensors = {settings.adapter.sensors[number]};
  const LaserCalibration result =
      calibrate_laser(options.log, options.prefix.of(options.settings()), settings.adapter,
                      settings.localiser, console);
  tell(result, console);
  for (const std::string& refusal : result.refusals) console.warn("refused: " + refusal);
  const auto values = values_of(result);
  if (values.empty()) return 1;
  const auto edit = [&](const std::string& text) {
    const std::size_t entry = options.output.empty() ? 0 : number;
    return config::with_numbers_of_entry(text, "cloud_adapter", "sensor", entry, values);
  };
  give(options, fmt::format("[[cloud_adapter.sensor]]\nchannel = \"{}\"\n", result.after.channel),
       edit, console);
  return 0;
}

}  // namespace voxlist::desk
