#pragma once

#include <cstdint>
#include <voxlist/pointcloud_t.hpp>

#include "services/voxlist/recording/omissions.h"
#include "voxlist/geometry/cloud.h"

namespace voxlist::desk {

/// Ranges between which points go into the map (m).
struct RangeLimits {
  double min_range_m = 0.05;
  double max_range_m = 100.0;
};

/// Tells a person what is odd with a scan's points: none or few of them, most of them out of range
/// (in millimetres?), many on the robot itself. `cloud` is what was made of the message.
void remark_on_points(std::int64_t number, const pointcloud_t& message, const Cloud& cloud,
                      const RangeLimits& limits, Omissions& omissions);

}  // namespace voxlist::desk
