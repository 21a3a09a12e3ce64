#include "voxlist/planning/rays/beam_spacing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"

namespace voxlist::planning {
namespace {

// Beams of one bearing of 1 deg are two only when they are farther apart than this (rad): beams of
// one line of the mirror scanner differ by less.
constexpr double kLeast_rad = 0.7 * kRadPerDeg;

constexpr std::size_t kBearings = 360;

// Clouds that are remembered: two sweeps of slices. The mirror's speed does not change faster.
constexpr std::size_t kClouds = 30;

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Elevations of the beams that go down, by bearing.
std::vector<std::vector<double>> beams_down(const Cloud& cloud) {
  std::vector<std::vector<double>> elevations_rad(kBearings);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3d way = (cloud.points[i] - cloud.origin(i)).cast<double>();
    if (way.z() >= 0.0) continue;
    const double turns = elementary::atan2(way.y(), way.x()) / kTurn_rad + 0.5;
    const auto bearing = static_cast<std::size_t>(turns * kBearings);
    elevations_rad[std::min(bearing, kBearings - 1)].push_back(
        elementary::atan2(way.z(), elementary::hypot(way.x(), way.y())));
  }
  return elevations_rad;
}

std::optional<double> spacing_of(const Cloud& cloud) {
  std::vector<double> gaps_rad;
  for (std::vector<double>& beams : beams_down(cloud)) {
    std::ranges::sort(beams);
    for (std::size_t i = 1; i < beams.size(); ++i)
      if (beams[i] - beams[i - 1] > kLeast_rad) gaps_rad.push_back(beams[i] - beams[i - 1]);
  }
  if (gaps_rad.empty()) return std::nullopt;
  return median(gaps_rad);
}

}  // namespace

void BeamSpacing::add(const Cloud& cloud_base) {
  const std::optional<double> spacing_rad = spacing_of(cloud_base);
  if (!spacing_rad) return;
  medians_rad_.push_back(*spacing_rad);
  if (medians_rad_.size() > kClouds) medians_rad_.pop_front();
}

double BeamSpacing::spacing_rad() const {
  if (medians_rad_.empty()) return kLeast_rad;
  std::vector<double> medians(medians_rad_.begin(), medians_rad_.end());
  return median(medians);
}

double next_on_floor_m(double from_m, double height_m, double spacing_rad) {
  const double down_rad = elementary::atan2(height_m, from_m) - spacing_rad;
  if (down_rad <= 0.0) return std::numeric_limits<double>::infinity();
  const auto [sine, cosine] = elementary::sine_cosine(down_rad);
  return height_m * cosine / sine;
}

}  // namespace voxlist::planning
