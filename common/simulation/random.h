#pragma once

#include <cstdint>

namespace voxlist::simulation {

/// Seeded random numbers that are the same bits with every compiler and library: SplitMix64
/// (Steele, Lea and Flood 2014), and normals as sums of uniforms, so that not even libm's rounding
/// enters.
class Random {
 public:
  /// One seed has as many independent streams as needed: the world, the wheels, each sweep.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

  /// Uniform over all 64-bit values.
  std::uint64_t bits();

  /// Uniform in [low, high).
  double uniform(double low, double high);

  /// Mean 0, standard deviation 1 (Irwin-Hall of 12): near normal, and never beyond 6.
  double normal();

 private:
  std::uint64_t state_;
};

}  // namespace voxlist::simulation
