#pragma once

#include <Eigen/Core>
#include <vector>

namespace voxlist::drawing {

/// One straight pen stroke of a letter.
struct GlyphStroke {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

/// Grid units: digits reach from y = 0 down to the baseline, letters below it to y = 8.
inline constexpr double kGlyphBaseline = 6.0;
inline constexpr double kGlyphWidth = 4.0;
inline constexpr double kGlyphAdvance = 5.6;

/// The strokes of a letter (upper case as lower case), digit or sign; none when the font lacks it.
const std::vector<GlyphStroke>& glyph(char letter);

}  // namespace voxlist::drawing
