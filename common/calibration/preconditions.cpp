#include "calibration/preconditions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace voxlist {
namespace {

constexpr double kStands_m = 0.01;
constexpr double kStands_rad = 0.2 * kRadPerDeg;
constexpr std::size_t kMinBeams = 1000;
constexpr double kUsedSide = 0.05;        // share of the beams
constexpr double kOneSpeed = 0.1;         // relative
constexpr double kThickSurface_m = 0.03;  // an LMS 200's noise is a third of it
constexpr double kSurprisingInPlausible = 2.0;
constexpr double kUnknownInPlausible = 0.3;

template <class... Values>
std::string text(const char* format, Values... values) {
  std::array<char, 400> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  return buffer.data();
}

std::optional<std::string> moved(const std::vector<StampedPose2>& odometry) {
  double far_m = 0.0, far_rad = 0.0;
  for (const StampedPose2& pose : odometry) {
    far_m = std::max(far_m, distance_m(pose.pose, odometry.front().pose));
    far_rad = std::max(far_rad, turn_rad(pose.pose, odometry.front().pose));
  }
  if (far_m <= kStands_m && far_rad <= kStands_rad) return std::nullopt;
  return text("the robot moved by %.3f m and %.2f deg, let it stand still for a minute", far_m,
              far_rad / kRadPerDeg);
}

double share_of_side(const std::vector<MirrorBeam>& beams, const ParameterVector& parameters,
                     int side) {
  const MirrorModel<> model = mirror_model(parameters.data());
  const auto is_of_side = [&](const MirrorBeam& beam) {
    return model.reflect(beam.psi_rad, beam.beam_rad).side == side;
  };
  return static_cast<double>(std::ranges::count_if(beams, is_of_side)) /
         static_cast<double>(beams.size());
}

std::string refusal_of(const ParameterInfo& info, double sd) {
  if (sd > kUnknownInPlausible * info.plausible)
    return text("%s: cannot be told from this log; %s", info.key, info.advice);
  return text("%s: known only to +-%.*f %s, needed are %.*f; %s", info.key, info.decimals,
              sd * info.file_units, info.unit, info.decimals, info.limit * info.file_units,
              info.advice);
}

bool has_one_speed(const std::vector<MirrorBeam>& beams) {
  std::vector<double> rates;
  for (const MirrorBeam& beam : beams) rates.push_back(beam.rate_radps);
  std::ranges::sort(rates);
  const double low = rates[rates.size() / 10], high = rates[rates.size() * 9 / 10];
  return high - low < kOneSpeed * std::max(std::abs(low), std::abs(high));
}

}  // namespace

std::vector<std::string> unusable(const CalibrationInput& input, const BeamSet& set,
                                  std::size_t min_lines) {
  std::vector<std::string> refusals;
  if (set.lines < min_lines) {
    refusals.push_back(
        text("%zu lines of LASER with a LOCKED mirror are fewer than %zu (%zu more "
             "have none), record a minute and see that mirror_monitor says LOCKED",
             set.lines, min_lines, set.lines_without_mirror));
  } else if (set.beams.size() < kMinBeams) {
    refusals.push_back(text("only %zu beams met anything, check LASER", set.beams.size()));
  }
  if (auto why = moved(input.odometry)) refusals.push_back(std::move(*why));
  return refusals;
}

Held held_parameters(const std::vector<MirrorBeam>& beams, const ParameterVector& start) {
  Held held;
  if (has_one_speed(beams)) {
    held.parameters[kLatency] = true;
    held.reasons.emplace_back(
        "latency_ms is held: at one speed of the mirror it is the same as a phase, and the phases "
        "hold for this speed; to tell them apart record half of the log at another speed");
  }
  for (const int side : {0, 1}) {
    if (share_of_side(beams, start, side) > kUsedSide) continue;
    held.parameters[side == 0 ? kPhase0 : kPhase1] = true;
    held.parameters[side == 0 ? kOffset0 : kOffset1] = true;
    held.reasons.push_back(
        text("side %d of the mirror is not in use: what belongs to it is held", side));
  }
  return held;
}

std::vector<std::string> refusals_of(const std::optional<CalibrationAnswer>& answer,
                                     bool has_level_surface, bool has_settled) {
  if (!answer) return {"no large flat surface in sight, stand in a room with walls"};
  std::vector<std::string> refusals;
  if (!has_level_surface) {
    refusals.emplace_back(
        "mirror_phase_0_deg, mirror_phase_1_deg: neither floor nor ceiling in sight that would say "
        "what is level, stand where one is");
  }
  for (int i = has_level_surface ? kPhase0 : kHeight; i < kParameters; ++i) {
    const ParameterInfo& info = kParameterInfos[static_cast<std::size_t>(i)];
    if (answer->sd[i] > info.limit) refusals.push_back(refusal_of(info, answer->sd[i]));
  }
  if (!has_settled)
    refusals.emplace_back("the surfaces do not settle: does the robot or much of the room move?");
  return refusals;
}

std::vector<std::string> warnings_of(const CalibrationAnswer& answer,
                                     const ParameterVector& start) {
  std::vector<std::string> warnings;
  if (answer.thickness_after_m > kThickSurface_m)
    warnings.push_back(
        text("surfaces stay %.0f mm thick, does the robot sway?", answer.thickness_after_m * 1e3));
  for (std::size_t i = 0; i < kParameterInfos.size(); ++i) {
    const ParameterInfo& info = kParameterInfos[i];
    const int k = static_cast<int>(i);
    const double change = answer.parameters[k] - start[k];
    if (std::abs(change) > kSurprisingInPlausible * info.plausible)
      warnings.push_back(text("%s changed by %.*f %s, is the start value right?", info.key,
                              info.decimals, change * info.file_units, info.unit));
  }
  return warnings;
}

}  // namespace voxlist
