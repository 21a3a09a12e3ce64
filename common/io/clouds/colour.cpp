#include "voxlist/io/clouds/colour.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxlist::io {
namespace {

// Every eighth of the map; linear between them is within a few grey levels of the whole table.
constexpr std::array<Rgb, 9> kViridis{{{68, 1, 84},
                                       {71, 44, 122},
                                       {59, 81, 139},
                                       {44, 113, 142},
                                       {33, 144, 141},
                                       {39, 173, 129},
                                       {92, 200, 99},
                                       {170, 220, 50},
                                       {253, 231, 37}}};

std::uint8_t mix(std::uint8_t a, std::uint8_t b, double share) {
  return static_cast<std::uint8_t>(std::lround(a + share * (b - a)));
}

}  // namespace

Rgb mix(Rgb a, Rgb b, double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return {mix(a.r, b.r, s), mix(a.g, b.g, s), mix(a.b, b.b, s)};
}

Rgb viridis(double value) {
  const double position = std::clamp(value, 0.0, 1.0) * (kViridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(position), kViridis.size() - 2);
  return mix(kViridis[below], kViridis[below + 1], position - static_cast<double>(below));
}

}  // namespace voxlist::io
