#include "services/mapper/loops/return_watch.h"

#include "voxlist/mapping/loops/loop_search.h"

namespace voxlist::services {

void ReturnWatch::add(const Pose2& pose) {
  const double way_m = poses_.empty() ? 0.0 : ways_m_.back() + distance_m(poses_.back(), pose);
  if (comes_back(pose, way_m)) ++returns_;
  poses_.push_back(pose);
  ways_m_.push_back(way_m);
}

bool ReturnWatch::comes_back(const Pose2& pose, double way_m) const {
  for (std::size_t i = 0; i < poses_.size(); ++i)
    if (const double away_m = distance_m(poses_[i], pose);
        away_m <= sight_m_ && mapping::is_long_way(way_m - ways_m_[i], away_m))
      return true;
  return false;
}

}  // namespace voxlist::services
