#include "voxlist/calibration/preconditions.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxlist::calibration {
namespace {

// A robot stands still while odometry stays within these: an LMS 200's noise, and what it makes at
// 3 m.
constexpr double kStands_m = 0.01;
constexpr double kStands_rad = 0.2 * kRadPerDeg;

// Fewer beams than these tell nothing: a tenth of one sweep.
constexpr std::size_t kMinBeams = 1000;

// A side of the mirror is used when at least this share of the beams came by it.
constexpr double kUsedSide = 0.05;

// The mirror's speeds that differ by less than this share are one speed: then latency and phase
// cannot be told apart.
constexpr double kOneSpeed = 0.1;

// A surface thicker than this (m) is worth a warning: an LMS 200's noise is a third of it.
constexpr double kThickSurface_m = 0.03;

// In units of what is plausible for a parameter: a value beyond the first is worth a warning; one
// whose standard deviation is beyond the second is not known at all.
constexpr double kSurprisingInPlausible = 2.0;
constexpr double kUnknownInPlausible = 0.3;

std::optional<std::string> moved(const std::vector<StampedPose2>& odometry) {
  double far_m = 0.0, far_rad = 0.0;
  for (const StampedPose2& pose : odometry) {
    far_m = std::max(far_m, distance_m(pose.pose, odometry.front().pose));
    far_rad = std::max(far_rad, turn_rad(pose.pose, odometry.front().pose));
  }
  if (far_m <= kStands_m && far_rad <= kStands_rad) return std::nullopt;
  return fmt::format("the robot moved by {:.3f} m and {:.2f} deg, let it stand still for a minute",
                     far_m, far_rad / kRadPerDeg);
}

double share_of_side(const std::vector<MirrorBeam>& beams, const ParameterVector& parameters,
                     int side) {
  const scanner::MirrorModel<> model = mirror_model(parameters.data());
  const auto is_of_side = [&](const MirrorBeam& beam) {
    return model.reflect(beam.psi_rad, beam.beam_rad).side == side;
  };
  return static_cast<double>(std::ranges::count_if(beams, is_of_side)) /
         static_cast<double>(beams.size());
}

std::string refusal_of(const ParameterInfo& info, double sd) {
  if (sd > kUnknownInPlausible * info.plausible)
    return fmt::format("{}: cannot be told from this log; {}", info.key, info.advice);
  return fmt::format("{}: known only to +-{:.{}f} {}, needed are {:.{}f}; {}", info.key,
                     sd * info.file_units, info.decimals, info.unit, info.limit * info.file_units,
                     info.decimals, info.advice);
}

// The mirror's slow and fast speed, and whether they are two.
struct Speeds {
  double low_radps, high_radps;

  explicit Speeds(const std::vector<MirrorBeam>& beams) {
    std::vector<double> rates;
    for (const MirrorBeam& beam : beams) rates.push_back(beam.rate_radps);
    std::ranges::sort(rates);
    low_radps = rates[rates.size() / 10];
    high_radps = rates[rates.size() * 9 / 10];
  }

  bool are_one() const {
    return high_radps - low_radps < kOneSpeed * std::max(std::abs(low_radps), std::abs(high_radps));
  }

  // What both angles' wander makes of the time between them.
  double latency_sd_s(double wander_rad) const {
    return std::numbers::sqrt2 * wander_rad / (high_radps - low_radps);
  }
};

}  // namespace

std::vector<std::string> unusable(const CalibrationInput& input, const BeamSet& set,
                                  std::size_t min_lines) {
  std::vector<std::string> refusals;
  if (set.lines < min_lines) {
    refusals.push_back(
        fmt::format("{} lines of LASER with a LOCKED mirror are fewer than {} ({} more "
                    "have none), record a minute and see that mirror_monitor says LOCKED",
                    set.lines, min_lines, set.lines_without_mirror));
  } else if (set.beams.size() < kMinBeams) {
    refusals.push_back(fmt::format("only {} beams met anything, check LASER", set.beams.size()));
  }
  if (auto why = moved(input.odometry)) refusals.push_back(std::move(*why));
  return refusals;
}

Held held_parameters(const std::vector<MirrorBeam>& beams, const ParameterVector& start,
                     double mirror_wander_rad) {
  Held held;
  const Speeds speeds(beams);
  const ParameterInfo& latency = kParameterInfos[kLatency];
  if (speeds.are_one()) {
    held.parameters[kLatency] = true;
    held.reasons.emplace_back(
        "latency_ms is held: at one speed of the mirror it is the same as a phase, and the phases "
        "hold for this speed; to tell them apart record half of the log at another speed");
  } else if (speeds.latency_sd_s(mirror_wander_rad) > latency.limit) {
    held.parameters[kLatency] = true;
    held.reasons.push_back(fmt::format(
        "latency_ms is held: MIRROR wandered by {:.3f} deg, which is {:.2f} ms between the two "
        "speeds; to tell it record some minutes at each",
        mirror_wander_rad / kRadPerDeg,
        speeds.latency_sd_s(mirror_wander_rad) * latency.file_units));
  }
  for (const int side : {0, 1}) {
    if (share_of_side(beams, start, side) > kUsedSide) continue;
    held.parameters[side == 0 ? kPhase0 : kPhase1] = true;
    held.parameters[side == 0 ? kOffset0 : kOffset1] = true;
    held.reasons.push_back(
        fmt::format("side {} of the mirror is not in use: what belongs to it is held", side));
  }
  return held;
}

void add_wander(CalibrationAnswer& answer, const std::vector<MirrorBeam>& beams,
                double mirror_wander_rad) {
  const auto add = [&](Parameter parameter, double sd) {
    if (!answer.held[parameter]) answer.sd[parameter] = std::hypot(answer.sd[parameter], sd);
  };
  add(kPhase0, mirror_wander_rad);
  add(kPhase1, mirror_wander_rad);
  if (!answer.held[kLatency]) add(kLatency, Speeds(beams).latency_sd_s(mirror_wander_rad));
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
    warnings.push_back(fmt::format("surfaces stay {:.0f} mm thick, does the robot sway?",
                                   answer.thickness_after_m * 1e3));
  for (std::size_t i = 0; i < kParameterInfos.size(); ++i) {
    const ParameterInfo& info = kParameterInfos[i];
    const int k = static_cast<int>(i);
    const double change = answer.parameters[k] - start[k];
    if (std::abs(change) > kSurprisingInPlausible * info.plausible)
      warnings.push_back(fmt::format("{} changed by {:.{}f} {}, is the start value right?",
                                     info.key, change * info.file_units, info.decimals, info.unit));
  }
  return warnings;
}

}  // namespace voxlist::calibration
