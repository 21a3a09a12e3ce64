#include "services/voxlist/report/measured/scanner_room.h"

#include <algorithm>

#include "services/voxlist/report/measured/statistics.h"
#include "voxlist/calibration/parameters.h"

namespace voxlist::desk {

simulation::MirrorScannerConfig config_of(Build build) {
  simulation::MirrorScannerConfig config;
  if (build == Build::kFlexing) {
    config.mirror.flex_deg = 0.33;
    return config;
  }
  config.mirror.phase_deg = {0.25, -0.25};
  config.mirror.height_m += 0.005;
  config.mirror.offset_m = {0.004, 0.001};
  config.mirror.axis_yaw_deg = 0.3;
  config.mirror.axis_roll_deg = 0.3;
  config.latency_s = 0.001;
  return config;
}

scanner::CloudAssemblerConfig as_drawn() {
  scanner::CloudAssemblerConfig assembler;
  assembler.use_odometry = false;
  return assembler;
}

scanner::CloudAssemblerConfig calibrated(const ScannerRecording& recording, std::string& refusal) {
  scanner::CloudAssemblerConfig assembler = as_drawn();
  const calibration::Calibration found = calibration::calibrate(recording.input(), assembler, {});
  if (!found.refusals.empty()) refusal = found.refusals.front();
  if (found.answer && found.refusals.empty())
    assembler.geometry = calibration::with_parameters(assembler.geometry, found.answer->parameters);
  return assembler;
}

ClosestPoints closest_points(const ScannerRecording& recording,
                             const scanner::CloudAssemblerConfig& assembler) {
  const std::vector<Cloud> clouds = recording.clouds(assembler);
  ClosestPoints closest{closest_distances(clouds[clouds.size() - 3], clouds.back())};
  const auto shares = by_millimetre(closest.distances_m);
  const auto mode = std::ranges::max_element(shares) - shares.begin();
  closest.mode_m = (static_cast<double>(mode) + 0.5) * 1e-3;
  closest.median_m = percentile(closest.distances_m, 0.5);
  closest.mean_m = moments(closest.distances_m).mean;
  return closest;
}

}  // namespace voxlist::desk
