#pragma once
// What the elementary functions are made of. Not for others.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#ifdef __FAST_MATH__
#error "-ffast-math reorders sums, and the bits are others then"
#endif

namespace voxlist::elementary {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A number as the sum of two doubles: the nearest one, and what it is off by.
struct Two {
  double high, low;
};

/// Exactly a + b (Knuth).
inline Two sum(double a, double b) {
  const double high = a + b, rest = high - a;
  return {high, (a - (high - rest)) + (b - rest)};
}

/// Exactly a + b where |a| >= |b| or a = 0 (Dekker).
inline Two sorted_sum(double a, double b) {
  const double high = a + b;
  return {high, b - (high - a)};
}

/// The upper 26 bits of a number, and the rest (Veltkamp). Overflows beyond 2^995.
inline Two halves(double a) {
  const double scaled = a * 0x1.0000002p27, high = scaled - (scaled - a);
  return {high, a - high};
}

/// Exactly a b (Dekker), unless it is subnormal.
inline Two product(double a, double b) {
  const double high = a * b;
  const auto [a1, a2] = halves(a);
  const auto [b1, b2] = halves(b);
  return {high, ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2};
}

/// Sum of c[i] x^i. Even and odd terms go side by side: half the time of Horner's chain.
template <std::size_t kTerms>
double polynomial(const double (&c)[kTerms], double x) {
  const double square = x * x;
  double even = 0.0, odd = 0.0;
  for (std::size_t i = (kTerms + 1) / 2; i-- > 0;) even = even * square + c[2 * i];
  for (std::size_t i = kTerms / 2; i-- > 0;) odd = odd * square + c[2 * i + 1];
  return even + x * odd;
}

/// The nearest whole number, |x| < 2^51: as a double, and modulo 2^64.
struct Whole {
  explicit Whole(double x) : Whole(x + kShift, 0) {}

  double value;
  std::uint64_t bits;

 private:
  // Where a double's last bit is worth 1.
  static constexpr double kShift = 0x1.8p52;
  Whole(double shifted, int)
      : value(shifted - kShift),
        bits(std::bit_cast<std::uint64_t>(shifted) - std::bit_cast<std::uint64_t>(kShift)) {}
};

}  // namespace voxlist::elementary
