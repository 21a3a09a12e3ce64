#include "voxlist/matching/localisation/leaving.h"

#include <algorithm>

#include "voxlist/geometry/uncertain_pose.h"
#include "voxlist/matching/localisation/reach_match.h"

namespace voxlist::matching {
namespace {

// So far (m) a robot may go and still see most of what it saw: across a room or a street.
constexpr double kNear_m = 10.0;

}  // namespace

bool is_followed(const Localisation& found) {
  return found.confidence >= kSureInReach &&
         worst_sigma_m(found.modes.front().covariance) < kNear_m / 3.0;
}

bool is_near(const ScanMoment& placed, const ScanMoment& now, const Localisation& found,
             double max_speed_mps) {
  const auto since_us = now.utime_us - placed.utime_us;
  double way_m = static_cast<double>(since_us) * 1e-6 * max_speed_mps;
  if (!found.searched_whole_map && now.T_odom_base && placed.T_odom_base)
    way_m = std::min(way_m, distance_m(*now.T_odom_base, *placed.T_odom_base));
  return way_m < kNear_m;
}

}  // namespace voxlist::matching
