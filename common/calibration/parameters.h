#pragma once

#include <Eigen/Core>
#include <array>

#include "voxlist/geometry/angle.h"
#include "voxlist/scanner/sweep/mirror_model.h"
#include "voxlist/scanner/sweep/scanner_geometry.h"

namespace voxlist::calibration {

/// What calibration finds out about a scanner, in this order.
enum Parameter {
  kPhase0,     ///< true mirror angle minus reported, where side 0 reflects; radians
  kPhase1,     ///< the same for side 1
  kHeight,     ///< the mirror's axis above the optical centre; metres
  kOffset0,    ///< side 0's reflecting surface from the axis; metres
  kOffset1,    ///< the same for side 1
  kAxisYaw,    ///< the axis turned about z; radians
  kAxisRoll,   ///< and about x
  kLatency,    ///< LASER's time stamps late against MIRROR's; seconds
  kParameters  ///< how many there are
};

/// One number for each parameter: values, or their standard deviations. Radians, metres, seconds.
using ParameterVector = Eigen::Matrix<double, kParameters, 1>;

/// How a parameter is told to people and files.
struct ParameterInfo {
  const char* key;    ///< in the robot's table [cloud_assembler]
  const char* unit;   ///< there
  double file_units;  ///< how many of them are one radian, metre or second
  int decimals;       ///< there

  /// How far from its start value it may be at all: about one standard deviation, loose.
  double plausible;

  /// The greatest standard deviation that is an answer.
  double limit;

  /// What makes it visible to the laser.
  const char* advice;
};

// The limits: what moves a point at 6 m by less than a centimetre.
inline constexpr std::array<ParameterInfo, kParameters> kParameterInfos{{
    {"mirror_phase_0_deg", "deg", 1.0 / kRadPerDeg, 4, 10 * kRadPerDeg, 0.04 * kRadPerDeg,
     "stand where both sides of the mirror see floor and walls"},
    {"mirror_phase_1_deg", "deg", 1.0 / kRadPerDeg, 4, 10 * kRadPerDeg, 0.04 * kRadPerDeg,
     "stand where both sides of the mirror see floor and walls"},
    {"mirror_height_m", "m", 1.0, 5, 0.05, 0.0015,
     "stand with the robot turned by some 20 deg against walls that are near"},
    {"mirror_offset_0_m", "m", 1.0, 5, 0.01, 0.001,
     "stand with the robot turned by some 20 deg against walls that are near"},
    {"mirror_offset_1_m", "m", 1.0, 5, 0.01, 0.001,
     "stand with the robot turned by some 20 deg against walls that are near"},
    {"axis_yaw_deg", "deg", 1.0 / kRadPerDeg, 4, 3 * kRadPerDeg, 0.04 * kRadPerDeg,
     "stand where walls or ceiling are seen far to the left and right"},
    {"axis_roll_deg", "deg", 1.0 / kRadPerDeg, 4, 3 * kRadPerDeg, 0.04 * kRadPerDeg,
     "stand where walls or ceiling are seen far to the left and right"},
    {"latency_ms", "ms", 1e3, 4, 0.01, 0.0003,
     "record one half of the log at another speed of the mirror"},
}};

/// The parameters as the mirror's model; all but the latency.
template <class T>
scanner::MirrorModel<T> mirror_model(const T* parameters) {
  scanner::MirrorModel<T> model;
  model.phase_rad = {parameters[kPhase0], parameters[kPhase1]};
  model.height_m = parameters[kHeight];
  model.offset_m = {parameters[kOffset0], parameters[kOffset1]};
  model.axis_yaw_rad = parameters[kAxisYaw];
  model.axis_roll_rad = parameters[kAxisRoll];
  return model;
}

/// A scanner's parameters.
ParameterVector parameters_of(const scanner::ScannerGeometry& geometry);

/// The same scanner with these parameters.
scanner::ScannerGeometry with_parameters(scanner::ScannerGeometry geometry,
                                         const ParameterVector& parameters);

}  // namespace voxlist::calibration
