#include "voxlist/planning/virtual_scan/virtual_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"

namespace voxlist::planning {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

std::size_t bearing_of(const Eigen::Vector3f& p, int bearings) {
  const double turns = elementary::atan2(p.y(), p.x()) / kTurn_rad;
  const auto bearing = static_cast<int>(std::lround(turns * bearings));
  return static_cast<std::size_t>((bearing + bearings) % bearings);
}

struct Heights {
  double low_m, high_m;

  bool holds(float z) const { return z >= low_m && z <= high_m; }
  bool are_passed(float from, float to) const {
    return std::max(from, to) >= low_m && std::min(from, to) <= high_m;
  }
};

float nearer(float range_m, float hit_m) { return std::min(range_m, hit_m); }

float further(float range_m, float hit_m) {
  return range_m == kNothing ? hit_m : std::max(range_m, hit_m);
}

// A ray ended at this distance.
template <class Choose>
void note(float from_z, const Eigen::Vector3f& end, float range_m, const Heights& heights,
          const Choose& choose, float& range) {
  if (!heights.are_passed(from_z, end.z())) return;
  if (std::isnan(range)) range = kNothing;
  if (heights.holds(end.z())) range = choose(range, range_m);
}

}  // namespace

ScanBand band_of(const RobotProfile& robot) {
  ScanBand band;
  band.low_m = robot.step_m;
  band.high_m = robot.clear_height_m();
  band.min_range_m = robot.radius_m;
  return band;
}

VirtualScan virtual_scan(const Cloud& cloud_base, const ScanBand& band) {
  const Heights robot{band.low_m, band.high_m},
      walls{band.low_m, std::max(band.high_m, band.furthest_high_m)};
  const std::vector<float> unknown(static_cast<std::size_t>(band.bearings), kUnknown);
  VirtualScan scan{cloud_base.utime_us, kTurn_rad / band.bearings, unknown, unknown};
  for (std::size_t i = 0; i < cloud_base.points.size(); ++i) {
    const Eigen::Vector3f& p = cloud_base.points[i];
    const auto range_m = static_cast<float>(elementary::hypot(p.x(), p.y()));
    if (!p.allFinite() || range_m < band.min_range_m) continue;
    const std::size_t bearing = bearing_of(p, band.bearings);
    const float from_z = cloud_base.origin(i).z();
    note(from_z, p, range_m, robot, nearer, scan.nearest_m[bearing]);
    note(from_z, p, range_m, walls, further, scan.furthest_m[bearing]);
  }
  return scan;
}

}  // namespace voxlist::planning
