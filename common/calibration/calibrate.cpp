#include "voxlist/calibration/calibrate.h"

#include <algorithm>
#include <iterator>

#include "voxlist/calibration/preconditions.h"
#include "voxlist/calibration/steady_mirror.h"
#include "voxlist/calibration/thin_surfaces.h"

namespace voxlist::calibration {
namespace {

CalibrationAnswer answer_of(const ThinSurfaces& surfaces, const BeamSet& set) {
  CalibrationAnswer answer;
  answer.parameters = surfaces.fit().parameters;
  answer.sd = standard_deviations(surfaces.evidence(), surfaces.fit());
  answer.held = surfaces.evidence().held;
  answer.thickness_before_m = surfaces.thickness_before_m();
  answer.thickness_after_m = surfaces.thickness_after_m();
  answer.lines = set.lines;
  answer.beams = set.beams.size();
  answer.surfaces = surfaces.fit().planes.size();
  return answer;
}

}  // namespace

Calibration calibrate(const CalibrationInput& input, const scanner::CloudAssemblerConfig& scanner,
                      const CalibrationConfig& config) {
  Calibration result;
  const ParameterVector before = parameters_of(scanner.geometry);
  const SteadyMirror mirror = steadied(input.mirror);
  const BeamSet set = gather_beams(input.lines, mirror.states, scanner, config.max_beams);
  result.refusals = unusable(input, set, config.min_lines);
  if (!result.refusals.empty()) return result;

  Held held = held_parameters(set.beams, before, mirror.wander_rad);
  ThinSurfaces surfaces(set.beams, scanner.geometry, held.parameters, config.level_sd_deg);
  const bool has_settled = surfaces.run();
  result.warnings = std::move(held.reasons);
  if (!surfaces.evidence().contacts.empty()) result.answer = answer_of(surfaces, set);
  result.refusals = refusals_of(result.answer, surfaces.evidence().level.has_value(), has_settled);
  if (!result.answer) return result;
  std::ranges::move(warnings_of(*result.answer, before), std::back_inserter(result.warnings));
  add_wander(*result.answer, set.beams, mirror.wander_rad);
  return result;
}

}  // namespace voxlist::calibration
