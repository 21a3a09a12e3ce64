#include "services/voxlist/report/measured/statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxlist/geometry/elementary.h"

namespace voxlist::desk {
namespace {

// Standard deviations from which on a normal density is drawn as 0.
constexpr double kBeyond = 4.5;

}  // namespace

Moments moments(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto count = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value;
  const double mean = sum / count;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / std::max(1.0, count - 1.0))};
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

double normal_density(double value, const Moments& of) {
  const double z = (value - of.mean) / of.sd;
  return elementary::exp(-0.5 * z * z) / (of.sd * std::sqrt(2.0 * std::numbers::pi));
}

double distance_from_normal(std::vector<double> values, const Moments& of) {
  std::ranges::sort(values);
  const auto count = static_cast<double>(values.size());
  double greatest = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double share = 0.5 * std::erfc((of.mean - values[i]) / (of.sd * std::numbers::sqrt2));
    const auto before = static_cast<double>(i);
    greatest = std::max({greatest, share - before / count, (before + 1.0) / count - share});
  }
  return greatest;
}

std::vector<Bar> histogram(const std::vector<double>& values, int bins) {
  if (values.empty()) return {};
  const auto [low, high] = std::ranges::minmax(values);
  const double width = std::max(high - low, 1e-9) / bins;
  std::vector<Bar> bars;
  for (int i = 0; i < bins; ++i) bars.push_back({low + i * width, low + (i + 1) * width, 0.0});
  for (const double value : values) {
    const auto bin = static_cast<std::size_t>((value - low) / width);
    bars[std::min(bin, bars.size() - 1)].height += 1.0 / static_cast<double>(values.size());
  }
  return bars;
}

std::vector<Eigen::Vector2d> normal_curve(const Moments& of, double low, double high,
                                          double width) {
  constexpr int kSteps = 100;
  const double from = std::max(low, of.mean - kBeyond * of.sd);
  const double to = std::min(high, of.mean + kBeyond * of.sd);
  std::vector<Eigen::Vector2d> curve;
  if (from > low) curve.emplace_back(low, 0.0);
  for (int i = 0; i <= kSteps; ++i) {
    const double at = from + (to - from) * i / kSteps;
    curve.emplace_back(at, normal_density(at, of) * width);
  }
  if (to < high) curve.emplace_back(high, 0.0);
  return curve;
}

}  // namespace voxlist::desk
