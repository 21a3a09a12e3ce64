#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/calibration/mirror_beam.h"
#include "voxlist/calibration/parameters.h"
#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/laser_line.h"
#include "voxlist/geometry/mirror_state.h"
#include "voxlist/scanner/sweep/cloud_assembler_config.h"

namespace voxlist::calibration {

/// About a minute of a static room, each in the order of time.
struct CalibrationInput {
  std::vector<LaserLine> lines;
  std::vector<MirrorState> mirror;
  std::vector<StampedPose2> odometry;  ///< to see that the robot stood; may be empty
};

/// Settings of a calibration.
struct CalibrationConfig {
  /// Evenly chosen from all: time grows with it.
  std::size_t max_beams = 40'000;

  /// Fewer lines with a mirror angle say too little.
  std::size_t min_lines = 1000;

  /// How level floors are (standard deviation): it limits how well the turn of the whole cloud
  /// about the mirror's axis can be known.
  double level_sd_deg = 0.05;
};

/// What a calibration found.
struct CalibrationAnswer {
  ParameterVector parameters, sd;

  /// Parameters that a log of its kind cannot tell; they kept their values (the latency, when the
  /// mirror had one speed; a side's, when the mirror has only the other).
  std::array<bool, kParameters> held{};

  /// RMS distance of the beams from their surfaces, before and after.
  double thickness_before_m = 0.0, thickness_after_m = 0.0;

  std::size_t lines = 0, beams = 0, surfaces = 0;
};

/// An answer may be used only without refusals.
struct Calibration {
  /// Nothing when the calibration was refused before it had found anything.
  std::optional<CalibrationAnswer> answer;

  /// Each one line: what the log cannot tell, why, and what to do.
  std::vector<std::string> refusals;

  /// Each one line: what is held, or odd.
  std::vector<std::string> warnings;
};

/// Estimates the parameters of a scanner that stood still, from the flatness of walls, floor and
/// ceiling: large surfaces are found in the cloud, Ceres makes them thin over surfaces and
/// parameters together, and again with a narrower idea of who belongs to a surface, until it
/// settles. `scanner` is what is known so far, with its true mount: the floor (else the
/// ceiling) is taken for level. The same input gives the same answer. Seconds.
Calibration calibrate(const CalibrationInput& input, const scanner::CloudAssemblerConfig& scanner,
                      const CalibrationConfig& config);

}  // namespace voxlist::calibration
