#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

namespace voxlist {

/// One line of a 2D laser: the beams of half a turn of its own mirror, in the laser's frame. Beam i
/// leaves at angle first_angle_rad + i * step_rad, in direction (0, cos a, sin a).
struct LaserLine {
  /// When the first beam left, microseconds.
  std::int64_t utime_us = 0;

  double first_angle_rad = 0.0;
  double step_rad = std::numbers::pi / 180.0;

  /// Metres from the optical centre, as measured; +infinity: nothing within the greatest range;
  /// NaN: no measurement.
  std::vector<float> ranges_m;

  /// 1 for beams whose receiver was dazzled (their range is NaN), else 0. Empty: none was.
  std::vector<std::uint8_t> dazzled;

  double angle_rad(std::size_t beam) const {
    return first_angle_rad + static_cast<double>(beam) * step_rad;
  }
};

/// One turn of the LMS 200's own mirror: 75 a second.
inline constexpr double kLaserTurn_us = 1e6 / 75.0;

/// How long after a line's first beam another of its beams left, microseconds.
inline double beam_delay_us(const LaserLine& line, std::size_t beam) {
  return static_cast<double>(beam) * line.step_rad / (2.0 * std::numbers::pi) * kLaserTurn_us;
}

}  // namespace voxlist
