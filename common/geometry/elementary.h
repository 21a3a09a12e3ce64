#pragma once

namespace voxlist {

/// Sine and its relatives as the same bits on every machine. The C library's take other
/// instructions on other processors and round otherwise from one version to the next, which moves a
/// keyframe by its last digit, and a map's hash with it. These are additions, multiplications,
/// divisions and square roots of doubles alone, which IEEE 754 rounds one way only, so long as the
/// compiler fuses and reorders nothing (-ffp-contract=off, no -ffast-math: cmake/Toolchain.cmake).
///
/// Not correctly rounded, for sameness does not need it: the error is below 1 unit in the last
/// place (0.95 at most over 2 million arguments of each kind, against long double). Zeros,
/// infinities, NaN, subnormal and huge arguments come out as the C standard wants them; errno and
/// exception flags do not. All expect rounding to nearest.
///
/// Everything that reaches a map, a pose or a confidence calls these; tests/geometry/
/// same_bits_test.cpp reads the sources for the C library's. Drawing and calibration may call
/// those.
namespace elementary {

struct SineCosine {
  double sine, cosine;
};

/// Both at the price of little more than one.
SineCosine sine_cosine(double angle_rad);

double sin(double angle_rad);
double cos(double angle_rad);

/// Angle of the vector (x, y), in [-pi, pi].
double atan2(double y, double x);

double exp(double x);
double log(double x);

/// log(1 + x), precise near x = 0.
double log1p(double x);

/// Length of the vector (x, y), without overflow in between.
double hypot(double x, double y);

}  // namespace elementary
}  // namespace voxlist
