#include "services/voxlist/maps/map_run.h"

#include <utility>

namespace voxlist::desk {

void MapRun::localise(Scan scan) {
  note(scan);
  matching::Localisation result = localiser_.localise(scan.cloud, scan.T_odom_base);
  if (!result.tracking() && unconfirmed_) {
    begin_anew();
    result = localiser_.localise(scan.cloud, scan.T_odom_base);
  }
  if (!result.tracking()) return note_lost(scan, result.state);
  if (unconfirmed_) finish();
  const Pose2& pose = result.modes.front().T_map_base;
  trajectory_.push_back({scan.cloud.utime_us, to_pose3(pose)});
  if (!builder_->wants(scan.cloud, pose)) return;
  add({to_pose3(pose), std::move(scan.cloud)});
  localiser_.map_grew(builder_->changed_blocks());
}

void MapRun::place(Scan scan, const Pose3& T_map_base) {
  trajectory_.push_back({scan.cloud.utime_us, T_map_base});
  keep_(builder_->add({T_map_base, std::move(scan.cloud)}));
}

void MapRun::finish() {
  if (unconfirmed_) keep_(*unconfirmed_);
  unconfirmed_.reset();
}

RunFigures MapRun::figures() const {
  RunFigures figures;
  figures.placed = std::ssize(trajectory_);
  figures.lost = lost_;
  figures.ambiguous = ambiguous_;
  figures.first_lost = first_lost_;
  figures.odometry = odometry_;
  return figures;
}

void MapRun::note(const Scan& scan) {
  if (!first_us_) first_us_ = scan.cloud.utime_us;
  odometry_ = odometry_ || scan.T_odom_base;
}

void MapRun::note_lost(const Scan& scan, matching::LocalisationState state) {
  ++(state == matching::LocalisationState::kAmbiguous ? ambiguous_ : lost_);
  const double seconds = static_cast<double>(scan.cloud.utime_us - *first_us_) * 1e-6;
  if (!first_lost_) first_lost_ = LostScan{scan.number, seconds};
}

void MapRun::add(mapping::Keyframe keyframe) {
  const bool first = builder_->poses().empty();
  keyframe = builder_->add(std::move(keyframe));
  if (first)
    unconfirmed_ = std::move(keyframe);
  else
    keep_(keyframe);
}

void MapRun::begin_anew() {
  unconfirmed_.reset();
  lost_ += std::ssize(trajectory_);
  trajectory_.clear();
  builder_.emplace(*empty_);
  localiser_.forget();
}

}  // namespace voxlist::desk
