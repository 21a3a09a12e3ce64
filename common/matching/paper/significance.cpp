#include "voxlist/matching/paper/significance.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "voxlist/geometry/elementary.h"
#include "voxlist/system/check.h"

namespace voxlist::matching {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void check(const ChanceModel& m) {
  if (m.volume_voxels >= 1 && m.map_voxels >= 0 && m.map_voxels <= m.volume_voxels &&
      m.scan_voxels >= 0 && m.scan_voxels <= m.volume_voxels) {
    return;
  }
  throw std::invalid_argument(fmt::format("ChanceModel: V = {}, N = {}, n = {}", m.volume_voxels,
                                          m.map_voxels, m.scan_voxels));
}

std::int64_t lowest_overlap(const ChanceModel& m) {
  return std::max<std::int64_t>(0, m.scan_voxels - (m.volume_voxels - m.map_voxels));
}

std::int64_t highest_overlap(const ChanceModel& m) { return std::min(m.scan_voxels, m.map_voxels); }

// The factorial of a small whole number.
double factorial(double x) {
  double product = 1.0;
  for (double i = 2.0; i <= x; i += 1.0) product *= i;
  return product;
}

// ln(x!) less its leading terms (x + 1/2) ln x - x + ln(2 pi) / 2. Precondition: x >= 1.
double stirling_rest(double x) {
  if (x < 16.0) {
    return elementary::log(factorial(x)) - (x + 0.5) * elementary::log(x) + x -
           0.5 * elementary::log(2.0 * std::numbers::pi);
  }
  const double x2 = x * x;
  return (1.0 / 12.0 - (1.0 / 360.0 - (1.0 / 1260.0 - 1.0 / (1680.0 * x2)) / x2) / x2) / x;
}

// ln C(a, b). A difference of lgamma's would lose all digits in volumes of 10^12 voxels and more:
// here the large parts a ln a have cancelled on paper.
double log_choose(std::int64_t a, std::int64_t b) {
  if (b == 0 || b == a) return 0.0;
  const auto whole = static_cast<double>(a), part = static_cast<double>(std::min(b, a - b));
  const double rest = whole - part;
  return part * elementary::log(whole / part) - rest * elementary::log1p(-part / whole) +
         0.5 * elementary::log(whole / (2.0 * std::numbers::pi * part * rest)) +
         stirling_rest(whole) - stirling_rest(part) - stirling_rest(rest);
}

double log_probability(const ChanceModel& m, std::int64_t k) {
  return log_choose(m.map_voxels, k) +
         log_choose(m.volume_voxels - m.map_voxels, m.scan_voxels - k) -
         log_choose(m.volume_voxels, m.scan_voxels);
}

// P(k + 1) / P(k).
double ratio(const ChanceModel& m, std::int64_t k) {
  const auto free_left =
      static_cast<double>(m.volume_voxels - m.map_voxels - m.scan_voxels + k + 1);
  return static_cast<double>(m.map_voxels - k) * static_cast<double>(m.scan_voxels - k) /
         (static_cast<double>(k + 1) * free_left);
}

// Sum of P(k) / P(start) for k from start up to the highest overlap, or down to `lowest`. Terms
// that no longer change the sum end it: they only get smaller, because the start is at or above
// (below) the mode.
double sum_up(const ChanceModel& m, std::int64_t start) {
  double sum = 1.0, term = 1.0;
  for (std::int64_t k = start; k < highest_overlap(m) && term > 1e-20 * sum; ++k) {
    term *= ratio(m, k);
    sum += term;
  }
  return sum;
}

double sum_down(const ChanceModel& m, std::int64_t start, std::int64_t lowest) {
  double sum = 1.0, term = 1.0;
  for (std::int64_t k = start; k > lowest && term > 1e-20 * sum; --k) {
    term /= ratio(m, k - 1);
    sum += term;
  }
  return sum;
}

std::int64_t mode(const ChanceModel& m) {
  const double value = (static_cast<double>(m.scan_voxels) + 1.0) *
                       (static_cast<double>(m.map_voxels) + 1.0) /
                       (static_cast<double>(m.volume_voxels) + 2.0);
  return std::clamp(static_cast<std::int64_t>(value), lowest_overlap(m), highest_overlap(m));
}

}  // namespace

double occupied_share(const ChanceModel& model) {
  check(model);
  return static_cast<double>(model.map_voxels) / static_cast<double>(model.volume_voxels);
}

double overlap_mean(const ChanceModel& model) {
  return static_cast<double>(model.scan_voxels) * occupied_share(model);
}

double overlap_variance(const ChanceModel& model) {
  const double p = occupied_share(model);
  if (model.volume_voxels == 1) return 0.0;
  return static_cast<double>(model.scan_voxels) * p * (1.0 - p) *
         (static_cast<double>(model.volume_voxels - model.scan_voxels) /
          static_cast<double>(model.volume_voxels - 1));
}

double log10_overlap_probability(const ChanceModel& model, std::int64_t overlap) {
  check(model);
  if (overlap < lowest_overlap(model) || overlap > highest_overlap(model)) return -kInfinity;
  return log_probability(model, overlap) / std::numbers::ln10;
}

double log10_overlap_tail(const ChanceModel& model, std::int64_t overlap) {
  check(model);
  if (overlap <= lowest_overlap(model)) return 0.0;
  if (overlap > highest_overlap(model)) return -kInfinity;
  // Outward from the largest term, so that no partial sum can overflow.
  const std::int64_t start = std::max(overlap, mode(model));
  const double sum = sum_up(model, start) + sum_down(model, start, overlap) - 1.0;
  return std::min(0.0, (log_probability(model, start) + elementary::log(sum)) / std::numbers::ln10);
}

double log10_best_of(double log10_tail, double poses) {
  VOXLIST_CHECK(poses >= 1.0, std::to_string(poses) + " poses");
  return std::min(0.0, log10_tail + elementary::log(poses) / std::numbers::ln10);
}

double required_z(double p_max, double poses) {
  const double tail = p_max / poses;
  if (!(p_max > 0.0 && p_max < 1.0 && poses >= 1.0 && tail > 1e-300)) {
    throw std::invalid_argument(fmt::format("required_z: p_max = {}, poses = {}", p_max, poses));
  }
  // The normal tail falls steadily, so halving an interval always ends at its root.
  double low = -40.0, high = 40.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2.0;
    (0.5 * std::erfc(middle / std::numbers::sqrt2) > tail ? low : high) = middle;
  }
  return low;
}

}  // namespace voxlist::matching
