#include "voxlist/simulation/random.h"

namespace voxlist::simulation {
namespace {

constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15;

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream)
    : state_(mix(seed + kGoldenGamma) ^ mix(~stream)) {}

std::uint64_t Random::bits() { return mix(state_ += kGoldenGamma); }

double Random::uniform(double low, double high) {
  return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53;
}

double Random::normal() {
  double sum = 0.0;
  for (int i = 0; i < 12; ++i) sum += uniform(0.0, 1.0);
  return sum - 6.0;
}

}  // namespace voxlist::simulation
