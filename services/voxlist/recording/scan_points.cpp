#include "services/voxlist/recording/scan_points.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

namespace voxlist::desk {
namespace {

// Scans with fewer points tell nothing of a place.
constexpr std::size_t kFewPoints = 50;

// Where more than this share of the points is nearer than a scanner measures, a person should know.
constexpr double kManyNear = 0.05;

// Ranges of the finite points, without those that stand for "nothing came back".
struct Ranges {
  std::vector<float> all_m;
  std::size_t near = 0, far = 0;

  double median_m() {
    const auto middle = all_m.begin() + static_cast<std::ptrdiff_t>(all_m.size() / 2);
    std::ranges::nth_element(all_m, middle);
    return static_cast<double>(*middle);
  }
};

Ranges ranges_of(const pointcloud_t& message, const RangeLimits& limits) {
  Ranges ranges;
  for (const auto& row : message.points) {
    if (row.size() != 3) continue;
    const auto range_m = Eigen::Vector3d(row[0], row[1], row[2]).norm();
    if (!std::isfinite(range_m)) continue;
    ranges.near += range_m < limits.min_range_m;
    ranges.far += range_m > limits.max_range_m;
    ranges.all_m.push_back(static_cast<float>(range_m));
  }
  return ranges;
}

}  // namespace

void remark_on_points(std::int64_t number, const pointcloud_t& message, const Cloud& cloud,
                      const RangeLimits& limits, Omissions& omissions) {
  Ranges ranges = ranges_of(message, limits);
  const std::size_t points = ranges.all_m.size();
  if (2 * ranges.far > points) {
    omissions.remark(
        "far", fmt::format("scan {}: {} of {} points lie beyond max_range_m, {:g} m, half of them "
                           "beyond {:.0f} m: are they millimetres? They must be in metres, in base",
                           number, ranges.far, points, limits.max_range_m, ranges.median_m()));
  } else if (cloud.points.size() < kFewPoints) {
    omissions.remark("few", fmt::format("scan {} has {} points: was the lens covered, or "
                                        "nothing in range?",
                                        number, cloud.points.size()));
  }
  if (static_cast<double>(ranges.near) > kManyNear * static_cast<double>(points)) {
    omissions.remark("near",
                     fmt::format("scan {}: {} of {} points are 0,0,0 or nearer than min_range_m, "
                                 "{:g} m, and are left out",
                                 number, ranges.near, points, limits.min_range_m));
  }
}

}  // namespace voxlist::desk
