#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "voxlist/geometry/elementary.h"
#include "voxlist/geometry/elementary_parts.h"
#include "voxlist/geometry/elementary_tables.h"

namespace voxlist::elementary {
namespace {

// An angle as a number of quarter turns and the rest, within an eighth.
struct QuarterTurns {
  std::uint64_t count;  ///< modulo 4
  Two rest_rad;
};

// Cody and Waite: pi/2 in four parts, of which three times the count are exact below 2^20.
QuarterTurns by_parts(double angle_rad) {
  const Whole n(angle_rad * (2.0 / std::numbers::pi));
  const Two first = sum(angle_rad - n.value * kHalfPi[0], -n.value * kHalfPi[1]);
  const Two second = sum(first.high, -n.value * kHalfPi[2]);
  return {n.bits, sorted_sum(second.high, (first.low + second.low) - n.value * kHalfPi[3])};
}

// 64 binary digits of 2/pi, `skipped` after those before the point begin.
std::uint64_t digits(std::size_t skipped) {
  const std::size_t word = skipped / 64, bit = skipped % 64;
  return bit == 0 ? kTwoByPi[word] : kTwoByPi[word] << bit | kTwoByPi[word + 1] >> (64 - bit);
}

// Payne and Hanek: only those digits of 2/pi count that do not make whole turns. |angle| > 1.
QuarterTurns by_digits(double angle_rad) {
  __extension__ using Wide = unsigned __int128;
  const auto bits = std::bit_cast<std::uint64_t>(std::abs(angle_rad));
  const std::uint64_t leading = std::uint64_t{1} << 52, mantissa = (bits & (leading - 1)) | leading;
  const std::size_t skipped = (bits >> 52) - 1075 + 62;
  const Wide third = Wide{mantissa} * digits(skipped + 128);
  const Wide second = Wide{mantissa} * digits(skipped + 64) + (third >> 64);
  const auto middle = static_cast<std::uint64_t>(second);
  const std::uint64_t upper = mantissa * digits(skipped) + static_cast<std::uint64_t>(second >> 64);
  // Quarter turns have their binary point after two digits; the fraction rounds to nearest.
  const auto fraction = static_cast<std::int64_t>(upper << 2 | middle >> 62);
  const std::uint64_t count = (upper >> 62) + (fraction < 0 ? 1 : 0);
  Two rest = sum(static_cast<double>(fraction >> 11) * 0x1p-53,
                 static_cast<double>(fraction & 0x7ff) * 0x1p-64);
  rest = sorted_sum(rest.high, rest.low + static_cast<double>(middle << 2) * 0x1p-128);
  const Two main = product(rest.high, kHalfPiTwo[0]);
  const double small = main.low + (rest.high * kHalfPiTwo[1] + rest.low * kHalfPiTwo[0]);
  const double sign = std::copysign(1.0, angle_rad);
  return {angle_rad < 0.0 ? -count : count, sorted_sum(sign * main.high, sign * small)};
}

QuarterTurns quarter_turns(double angle_rad) {
  const double size = std::abs(angle_rad);
  if (size <= std::numbers::pi / 4) return {0, {angle_rad, 0.0}};
  if (size < 0x1p20) return by_parts(angle_rad);
  if (size < kInfinity) return by_digits(angle_rad);
  return {0, {kNan, kNan}};
}

// Within an eighth of a turn.
double sine_of(const Two& angle) {
  const double r = angle.high, square = r * r;
  if (square < 0x1p-60) return r;  // and keeps the sign of zero
  return r + (r * square * polynomial(kSine, square) + angle.low * (1.0 - square / 2.0));
}

double cosine_of(const Two& angle) {
  const double r = angle.high, square = r * r, half = square / 2.0, main = 1.0 - half;
  const double rest = square * square * polynomial(kCosine, square) - r * angle.low;
  return main + (((1.0 - main) - half) + rest);
}

double sine_after(std::uint64_t quarters, const Two& rest) {
  const double size = quarters % 2 == 0 ? sine_of(rest) : cosine_of(rest);
  return quarters % 4 < 2 ? size : -size;
}

}  // namespace

SineCosine sine_cosine(double angle_rad) {
  const auto [quarters, rest] = quarter_turns(angle_rad);
  const double s = sine_of(rest), c = cosine_of(rest);
  const double sine = quarters % 2 == 0 ? s : c, cosine = quarters % 2 == 0 ? c : s;
  return {quarters % 4 < 2 ? sine : -sine, (quarters + 1) % 4 < 2 ? cosine : -cosine};
}

double sin(double angle_rad) {
  const auto [quarters, rest] = quarter_turns(angle_rad);
  return sine_after(quarters, rest);
}

double cos(double angle_rad) {
  const auto [quarters, rest] = quarter_turns(angle_rad);
  return sine_after(quarters + 1, rest);
}

}  // namespace voxlist::elementary
