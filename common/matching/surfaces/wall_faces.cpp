#include "voxlist/matching/surfaces/wall_faces.h"

#include <cmath>

namespace voxlist::matching {
namespace {

// Faces nearer to each other than this (m) are taken for one noisy surface: their means differ by
// two to three times the scanner's noise of 0.02 m. With 0.2, thin boards get one plane in their
// middle, and 12 % of the scans of a changed floor are not found (bench_tracking 40 1); 0.02 gives
// median errors up to a tenth larger.
constexpr double kSmallestGap_m = 0.05;

// Two faces leave at most this share of the variance across the plane within themselves. An even
// slab cut in its middle keeps a quarter of it, one noisy (normal) face 1 - 2 / pi, a third: the
// limit lies below both.
constexpr double kMostVarianceLeft = 0.2;

// Most steps of the search for the best cut: a bound. A cut that still moves then is taken as it
// is.
constexpr int kMostSteps = 6;

struct Layers {
  double low_sum = 0.0, high_sum = 0.0;
  int low_n = 0, high_n = 0;

  Layers(const Plane& plane, std::span<const Voxel> voxels, double cut) {
    for (const Voxel& v : voxels) {
      const double t = plane.distance(v);
      (t < cut ? low_sum : high_sum) += t;
      ++(t < cut ? low_n : high_n);
    }
  }

  bool one_is_empty() const { return low_n == 0 || high_n == 0; }
  double low() const { return low_sum / low_n; }
  double high() const { return high_sum / high_n; }
  double gap() const { return high() - low(); }
  // The variance of the two means about the mean of all.
  double variance_between() const {
    const double share = static_cast<double>(low_n) / static_cast<double>(low_n + high_n);
    return share * (1.0 - share) * gap() * gap();
  }
};

}  // namespace

std::optional<double> find_gap(const Plane& plane, std::span<const Voxel> voxels,
                               double resolution_m) {
  const double total = plane.deviations(0) * plane.deviations(0);
  // The variance of two equal layers is a quarter of their gap's square, of others less.
  const double smallest = kSmallestGap_m / resolution_m;  // in voxels
  if (4.0 * total < smallest * smallest) return std::nullopt;
  double cut = 0.0;
  Layers layers(plane, voxels, cut);
  for (int step = 1; step <= kMostSteps; ++step) {
    if (layers.one_is_empty()) return std::nullopt;
    const double middle = (layers.low() + layers.high()) / 2.0;
    if (middle == cut) break;
    cut = middle;
    if (step < kMostSteps) layers = Layers(plane, voxels, cut);
  }
  const bool two_faces = layers.gap() * resolution_m >= kSmallestGap_m &&
                         total - layers.variance_between() <= kMostVarianceLeft * total;
  return two_faces ? std::optional(cut) : std::nullopt;
}

}  // namespace voxlist::matching
