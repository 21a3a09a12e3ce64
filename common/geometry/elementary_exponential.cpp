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

// 2^power, -1022 <= power <= 1023.
double power_of_two(std::int64_t power) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(power + 1023) << 52);
}

// log(2^exponent (1 + f) + missed), where missed is that of log(1 + f) already.
double logarithm(double exponent, double f, double missed) {
  const double s = f / (2.0 + f), square = s * s;
  const double curve = s * (f - square * polynomial(kLogarithm, square));
  const Two main = sum(exponent * kLn2[0], f);
  return main.high + (main.low - (curve - (exponent * kLn2[1] + missed)));
}

// A positive, finite number as 2^exponent (1 + f), 1 + f from the square root of 1/2 to that of 2.
struct Scaled {
  double exponent, f;
};

Scaled scaled(double x) {
  const double lifted = x < 0x1p-1022 ? x * 0x1p54 : x;
  const auto bits = std::bit_cast<std::uint64_t>(lifted);
  const auto root = std::bit_cast<std::uint64_t>(std::numbers::sqrt2 / 2.0);
  const std::int64_t exponent = static_cast<std::int64_t>(bits - root) >> 52;
  const double mantissa =
      std::bit_cast<double>(bits - (static_cast<std::uint64_t>(exponent) << 52));
  return {static_cast<double>(exponent - (lifted == x ? 0 : 54)), mantissa - 1.0};
}

}  // namespace

double exp(double x) {
  if (!(x < 709.8)) return x + kInfinity;  // NaN stays NaN
  if (x < -745.2) return 0.0;
  const Whole n(x * (32.0 / std::numbers::ln2));
  const std::size_t k = n.bits % 32;
  const double r = (x - n.value * kLn2By32[0]) - n.value * kLn2By32[1];
  const double growth = r + r * r * polynomial(kExponential, r);
  const double mantissa = kPowersHigh[k] + (kPowersLow[k] + kPowersHigh[k] * growth);
  // Two factors, so that neither is too small or too large where the result is not.
  const std::int64_t power = static_cast<std::int64_t>(n.bits) >> 5, half = power >> 1;
  return mantissa * power_of_two(half) * power_of_two(power - half);
}

double log(double x) {
  if (!(x > 0.0)) return x == 0.0 ? -kInfinity : kNan;
  if (x == kInfinity) return x;
  const auto [exponent, f] = scaled(x);
  return logarithm(exponent, f, 0.0);
}

double log1p(double x) {
  if (!(x > -1.0)) return x == -1.0 ? -kInfinity : kNan;
  if (x == kInfinity || std::abs(x) < 0x1p-54) return x;
  const Two whole = sum(1.0, x);
  const auto [exponent, f] = scaled(whole.high);
  return logarithm(exponent, f, whole.low / whole.high);
}

}  // namespace voxlist::elementary
