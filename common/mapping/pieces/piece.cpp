#include "voxlist/mapping/pieces/piece.h"

#include <optional>
#include <span>
#include <utility>

#include "voxlist/mapping/pieces/carried_scans.h"

namespace voxlist::mapping {

Piece::Piece(const matching::LocaliserConfig& localiser, MapBuilder map, KeyframeSpool& spool)
    : builder_(std::move(map)), spool_(&spool), localiser_(builder_.map(), localiser) {}

Piece::Piece(const matching::LocaliserConfig& localiser, MapBuilder map, Keep keep)
    : builder_(std::move(map)),
      spool_(nullptr),
      keep_(std::move(keep)),
      localiser_(builder_.map(), localiser) {}

bool Piece::take(const Cloud& cloud, const matching::PoseMode& found,
                 const std::optional<Pose2>& T_odom_base) {
  const Pose3 T_piece_base = to_pose3(found.T_map_base, found.tilt);
  trajectory_.push_back({cloud.utime_us, T_piece_base});
  if (!builder_.wants(cloud, found.T_map_base, found.tilt)) return false;
  add({T_piece_base, cloud}, T_odom_base);
  return true;
}

void Piece::add(Cloud cloud, const Pose3& T_piece_base) {
  trajectory_.push_back({cloud.utime_us, T_piece_base});
  add({T_piece_base, std::move(cloud)}, std::nullopt);
}

void Piece::move_keyframes(const std::vector<Pose3>& T_piece_base) {
  const std::vector<StampedPose3> before = builder_.poses();
  std::vector<std::optional<Pose3>> poses;
  for (std::size_t i = 0; i < keyframes_.size(); ++i) {
    keyframes_[i].T_map_base = T_piece_base[i];
    poses.emplace_back(T_piece_base[i]);
  }
  builder_.move(poses, [this](std::size_t i) { return spool_->read(keyframes_[i]).cloud; });
  const auto carry = [&](Begin begin, Begin end) {
    carry_scans(std::span(trajectory_).subspan(begin.scan, end.scan - begin.scan),
                std::span(before).subspan(begin.keyframe, end.keyframe - begin.keyframe),
                std::span(builder_.poses()).subspan(begin.keyframe, end.keyframe - begin.keyframe));
  };
  if (first_session() > 0) carry({}, second_session_);
  carry(second_session_, {keyframes_.size(), trajectory_.size()});
}

void Piece::join(const Piece& other, const Pose2& T_this_other) {
  const Pose3 to_here = to_pose3(T_this_other);
  for (SpooledKeyframe keyframe : other.keyframes_) {
    keyframe.T_map_base = to_here * keyframe.T_map_base;
    const Keyframe added = add_to_map(other.spool_->read(keyframe));
    if (keep_)
      keep_(added, keyframe.T_odom_base);
    else
      keyframes_.push_back(keyframe);
  }
  for (const StampedPose3& pose : other.trajectory_)
    trajectory_.push_back({pose.utime_us, to_here * pose.pose});
}

void Piece::add(Keyframe keyframe, const std::optional<Pose2>& T_odom_base) {
  keyframe = add_to_map(std::move(keyframe));
  if (keep_) return keep_(keyframe, T_odom_base);
  keyframes_.push_back({spool_->add(keyframe), keyframe.T_map_base, T_odom_base});
}

Keyframe Piece::add_to_map(Keyframe keyframe) {
  keyframe = builder_.add(std::move(keyframe));
  localiser_.map_changed(builder_.changed_blocks());
  return keyframe;
}

}  // namespace voxlist::mapping
