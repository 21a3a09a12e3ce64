#pragma once

#include <numbers>

namespace voxlist {

/// Radians in a degree.
inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// Radians in a whole turn.
inline constexpr double kTurn_rad = 2.0 * std::numbers::pi;

}  // namespace voxlist
