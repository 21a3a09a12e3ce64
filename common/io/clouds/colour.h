#pragma once

#include <cstdint>

namespace voxlist::io {

/// A colour, 8 bits a channel.
struct Rgb {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;

  bool operator==(const Rgb&) const = default;
};

/// The colour `share` (0..1, clamped) of the way from a to b.
Rgb mix(Rgb a, Rgb b, double share);

/// Perceptually even colours from dark violet (0) over green to yellow (1) after the map "viridis";
/// clamped.
Rgb viridis(double value);

}  // namespace voxlist::io
