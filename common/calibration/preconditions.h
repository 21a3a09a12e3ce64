#pragma once

#include <optional>
#include <string>
#include <vector>

#include "voxlist/calibration/calibrate.h"

namespace voxlist::calibration {

/// Why a log cannot be used at all; empty when it can.
std::vector<std::string> unusable(const CalibrationInput& input, const BeamSet& set,
                                  std::size_t min_lines);

/// Parameters that a log of its kind cannot tell, and why.
struct Held {
  std::array<bool, kParameters> parameters{};
  std::vector<std::string> reasons;
};
Held held_parameters(const std::vector<MirrorBeam>& beams, const ParameterVector& start,
                     double mirror_wander_rad);

/// What MIRROR's own wander adds to the standard deviations.
void add_wander(CalibrationAnswer& answer, const std::vector<MirrorBeam>& beams,
                double mirror_wander_rad);

/// What an answer must not be used for, by parameter.
std::vector<std::string> refusals_of(const std::optional<CalibrationAnswer>& answer,
                                     bool has_level_surface, bool has_settled);

/// What is odd about an answer.
std::vector<std::string> warnings_of(const CalibrationAnswer& answer, const ParameterVector& start);

}  // namespace voxlist::calibration
