#include "voxlist/calibration/parameters.h"

namespace voxlist::calibration {
namespace {

// The settings, in the order of Parameter.
std::array<double*, kParameters> settings_of(scanner::ScannerGeometry& geometry) {
  return {&geometry.mirror_phase_0_deg, &geometry.mirror_phase_1_deg, &geometry.mirror_height_m,
          &geometry.mirror_offset_0_m,  &geometry.mirror_offset_1_m,  &geometry.axis_yaw_deg,
          &geometry.axis_roll_deg,      &geometry.latency_ms};
}

}  // namespace

ParameterVector parameters_of(const scanner::ScannerGeometry& geometry) {
  scanner::ScannerGeometry copy = geometry;
  const auto settings = settings_of(copy);
  ParameterVector result;
  for (std::size_t i = 0; i < settings.size(); ++i)
    result[static_cast<int>(i)] = *settings[i] / kParameterInfos[i].file_units;
  return result;
}

scanner::ScannerGeometry with_parameters(scanner::ScannerGeometry geometry,
                                         const ParameterVector& parameters) {
  const auto settings = settings_of(geometry);
  for (std::size_t i = 0; i < settings.size(); ++i)
    *settings[i] = parameters[static_cast<int>(i)] * kParameterInfos[i].file_units;
  return geometry;
}

}  // namespace voxlist::calibration
