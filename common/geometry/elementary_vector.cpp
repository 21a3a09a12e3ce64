#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "voxlist/geometry/elementary.h"
#include "voxlist/geometry/elementary_parts.h"
#include "voxlist/geometry/elementary_tables.h"

namespace voxlist::elementary {
namespace {

// y / x, and what the quotient is off by.
Two quotient(const Two& y, const Two& x) {
  const double u = y.high / x.high;
  const Two back = product(u, x.high);
  return {u, (((y.high - back.high) - back.low) + (y.low - u * x.low)) / x.high};
}

// Tangent that is left when (x, y) has been turned back by the angle whose tangent is t. Precise
// because t has few digits: its products are exact with half a number.
Two turned_back(double y, double x, double t) {
  const auto [x1, x2] = halves(x);
  const auto [y1, y2] = halves(y);
  const double gain = t * y;
  const Two along = sorted_sum(x, gain);
  return quotient(sum(y - t * x1, -t * x2), {along.high, along.low + ((t * y1 - gain) + t * y2)});
}

// Angle of (x, y), 0 <= y <= x: a tabulated one, and the rest.
Two first_octant(double y, double x, double slope) {
  const Whole step(32.0 * slope);
  const auto k = static_cast<std::size_t>(step.bits);
  const auto [u, missed] = turned_back(y, x, step.value / 32.0);
  const double square = u * u, curve = u * square * polynomial(kArcTangent, square);
  return {kArcTangentsHigh[k], u + (curve + (missed + kArcTangentsLow[k]))};
}

// The angle of (-x, y), (y, x) or (-y, x) from that of (x, y): quarter turns, plus or minus it.
double from_first_octant(const Two& angle, bool steep, bool backwards) {
  const double quarters = steep ? 1.0 : (backwards ? 2.0 : 0.0);
  const double sign = steep != backwards ? -1.0 : 1.0;
  const Two main = sum(quarters * kHalfPiTwo[0], sign * angle.high);
  return main.high + (main.low + (quarters * kHalfPiTwo[1] + sign * angle.low));
}

// What brings numbers to where no product overflows or is subnormal.
double scale_of(double largest) {
  if (largest > 0x1p500) return 0x1p-600;
  return largest < 0x1p-400 ? 0x1p600 : 1.0;
}

}  // namespace

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return kNan;
  double along = std::abs(x), across = std::abs(y);
  if (std::max(along, across) == kInfinity) {
    along = along == kInfinity ? 1.0 : 0.0;
    across = across == kInfinity ? 1.0 : 0.0;
  }
  const bool steep = across > along;
  if (steep) std::swap(along, across);
  const double slope = along == 0.0 ? 0.0 : across / along, scale = scale_of(along);
  const bool is_small = slope < 0x1p-60;  // an angle like its tangent
  const Two angle = is_small ? Two{0.0, slope} : first_octant(across * scale, along * scale, slope);
  return std::copysign(from_first_octant(angle, steep, std::signbit(x)), y);
}

double hypot(double x, double y) {
  const double large = std::max(std::abs(x), std::abs(y)),
               small = std::min(std::abs(x), std::abs(y));
  if (std::isinf(x) || std::isinf(y)) return kInfinity;
  if (std::isnan(x) || std::isnan(y)) return kNan;
  if (small <= large * 0x1p-60) return large + small;
  const double scale = scale_of(large), a = large * scale, b = small * scale;
  const Two a2 = product(a, a), b2 = product(b, b), square = sorted_sum(a2.high, b2.high);
  const double root = std::sqrt(square.high);
  const Two back = product(root, root);
  const double missed = (square.high - back.high) + (square.low + a2.low + b2.low - back.low);
  return (root + missed / (2.0 * root)) / scale;
}

}  // namespace voxlist::elementary
