// LASER and MIRROR: the part of convert.h that the scanner needs.
#include <algorithm>
#include <cmath>
#include <limits>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/planar_lidar_t.hpp>

#include "voxlist/bus/convert.h"
#include "voxlist/geometry/angle.h"

namespace voxlist::bus {
namespace {

// A mirror that turns faster than this (rad/s, 160 turns a second) is no mirror: the message is
// wrong.
constexpr double kMaxRate_radps = 1000.0;

float sane_range(float range_m) {
  const bool sane = range_m >= 0.0F && (range_m <= kMaxPoint_m || std::isinf(range_m));
  return sane ? range_m : std::numeric_limits<float>::quiet_NaN();
}

bool is_angle(double angle_rad) { return std::abs(angle_rad) <= kTurn_rad; }

}  // namespace

std::optional<LaserLine> from_message(const planar_lidar_t& message) {
  const std::size_t beams = message.ranges.size();
  const bool whole = beams > 0 && beams <= kMaxBeams &&
                     (message.intensities.empty() || message.intensities.size() == beams);
  const double span_rad = static_cast<double>(message.radstep) * static_cast<double>(beams);
  if (!whole || !is_sane_utime(message.utime) || !is_angle(message.rad0) || !is_angle(span_rad) ||
      message.radstep <= 0.0F) {
    return std::nullopt;
  }
  LaserLine line{message.utime, message.rad0, message.radstep, {}, {}};
  std::ranges::transform(message.ranges, std::back_inserter(line.ranges_m), sane_range);
  for (const float intensity : message.intensities) line.dazzled.push_back(intensity > 0.0F);
  return line;
}

std::optional<MirrorState> from_message(const mirror_state_t& message) {
  const bool sane = is_sane_utime(message.utime) && message.state >= mirror_state_t::SEARCHING &&
                    message.state <= mirror_state_t::FAULT && message.angle_rad >= 0.0 &&
                    message.angle_rad <= kTurn_rad &&
                    std::abs(message.rate_radps) <= kMaxRate_radps && message.residual_rad >= 0.0 &&
                    message.step_rad >= 0.0 && message.step_rad <= kTurn_rad;
  if (!sane) return std::nullopt;
  return MirrorState{message.utime,
                     static_cast<MirrorState::State>(message.state),
                     message.angle_known != 0,
                     message.reason,
                     message.angle_rad,
                     message.rate_radps,
                     message.half_revolutions,
                     message.residual_rad,
                     message.step_rad};
}

planar_lidar_t to_message(const LaserLine& line) {
  planar_lidar_t message{};
  message.utime = line.utime_us;
  message.nranges = static_cast<std::int32_t>(line.ranges_m.size());
  message.ranges = line.ranges_m;
  message.nintensities = static_cast<std::int32_t>(line.dazzled.size());
  message.intensities.assign(line.dazzled.begin(), line.dazzled.end());
  message.rad0 = static_cast<float>(line.first_angle_rad);
  message.radstep = static_cast<float>(line.step_rad);
  return message;
}

mirror_state_t to_message(const MirrorState& state) {
  mirror_state_t message{};
  message.utime = state.utime_us;
  message.state = static_cast<std::int8_t>(state.state);
  message.angle_known = state.angle_known;
  message.reason = state.reason;
  message.angle_rad = state.angle_rad;
  message.rate_radps = state.rate_radps;
  message.half_revolutions = state.half_revolutions;
  message.residual_rad = state.residual_rad;
  message.step_rad = state.step_rad;
  return message;
}

}  // namespace voxlist::bus
