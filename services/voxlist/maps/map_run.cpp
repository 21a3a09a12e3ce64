#include "services/voxlist/maps/map_run.h"

#include <utility>

namespace voxlist::desk {

void MapRun::localise(Scan scan) {
  const matching::Localisation result = localiser_.localise(scan.cloud, scan.T_odom_base);
  if (!result.tracking()) {
    ++(result.state == matching::LocalisationState::kAmbiguous ? ambiguous_ : lost_);
    return;
  }
  const Pose2& pose = result.modes.front().T_map_base;
  const Pose3 T_map_base = to_pose3(pose);
  trajectory_.push_back({scan.cloud.utime_us, T_map_base});
  if (!builder_.wants(scan.cloud, pose)) return;
  add({T_map_base, std::move(scan.cloud)});
  localiser_.map_grew(builder_.changed_blocks());
}

void MapRun::place(Scan scan, const Pose3& T_map_base) {
  trajectory_.push_back({scan.cloud.utime_us, T_map_base});
  add({T_map_base, std::move(scan.cloud)});
}

void MapRun::add(mapping::Keyframe keyframe) { keep_(builder_.add(std::move(keyframe))); }

}  // namespace voxlist::desk
